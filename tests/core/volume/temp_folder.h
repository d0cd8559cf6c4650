#pragma once
// A folder of its own for every test, gone afterwards.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace dubsar::testing_tools {

class TempFolder : public testing::Test {
 protected:
  TempFolder() { std::filesystem::create_directories(folder_); }
  ~TempFolder() override {
    std::error_code ignored;
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(folder_, ignored);
  }
  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path in(const std::string& name) const { return folder_ / name; }

  static std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  ("dubsar-" + std::to_string(::getpid()) + "-" +
                                   testing::UnitTest::GetInstance()->current_test_info()->test_suite_name() + "-" +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace dubsar::testing_tools
