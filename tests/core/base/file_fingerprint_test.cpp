// Copies are known, other files are told apart.

#include "core/base/files/file_fingerprint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace dubsar {
namespace {
namespace fs = std::filesystem;

TEST(FileFingerprint, IsThatOfACopyAndNotOfAnotherFile) {
  const fs::path folder = fs::temp_directory_path() / ("dubsar_fingerprint_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const auto write = [&](const char* name, std::string_view bytes) {
    std::ofstream(folder / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return folder / name;
  };
  for (const std::size_t size : {0, 1, 4095, 4096, 4097, 100'000, 1'000'000}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 2654435761u >> 13);
    const std::string found = file_fingerprint(write("a", bytes)).value();
    EXPECT_EQ(found, file_fingerprint(write("b", bytes)).value());
    EXPECT_EQ(found.substr(0, found.find('-')), std::to_string(size));
    EXPECT_NE(found, file_fingerprint(write("b", bytes + "x")).value());
    if (size == 0) continue;
    for (const std::size_t at : {std::size_t{0}, size - 1}) {
      std::string other = bytes;
      other[at] = static_cast<char>(other[at] + 1);
      EXPECT_NE(found, file_fingerprint(write("b", other)).value()) << size << ", " << at;
    }
  }
  EXPECT_EQ(file_fingerprint(folder).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(file_fingerprint(folder / "none").error().kind, ErrorKind::kNoInput);
  // FNV-1a of no bytes, and of "a" (Fowler, Noll and Vo's own vectors).
  EXPECT_EQ(file_fingerprint(write("b", "")).value(), "0-cbf29ce484222325");
  EXPECT_EQ(file_fingerprint(write("b", "a")).value(), "1-af63dc4c8601ec8c");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dubsar
