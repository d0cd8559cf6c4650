// Scans that change while they are read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/volume/formats/import.h"
#include "tests/core/image_io/tiff_fixture.h"
#include "tests/core/volume/hdf5_fixture.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ImportChanges : public testing_tools::TempFolder {
 protected:
  ImportOptions options(const std::string& name) {
    ImportOptions out;
    out.path = in(name);
    out.same_files = std::make_shared<std::vector<FileIdentity>>();
    return out;
  }
  /// Opened once, changed, and opened again: told, at the second opening and at the end.
  void expect_told(const ImportOptions& scan, const std::string& changed, const std::function<void()>& change) {
    scan.same_files->clear();
    ASSERT_TRUE(open_volume(scan));
    ASSERT_TRUE(open_volume(scan)) << "it is as it was";
    ASSERT_TRUE(check_unchanged(*scan.same_files));
    change();
    const auto again = open_volume(scan);
    ASSERT_FALSE(again) << changed;
    EXPECT_EQ(again.error().kind, ErrorKind::kTryAgain);
    EXPECT_THAT(again.error().message, HasSubstr(changed));
    EXPECT_THAT(again.error().message, HasSubstr("changed while it was read"));
    EXPECT_FALSE(check_unchanged(*scan.same_files));
  }
  /// The last byte is another one, and its time the same as before.
  static void patch_quietly(const fs::path& path) {
    const auto time = fs::last_write_time(path);
    std::string bytes = bytes_of(path);
    bytes.back() = static_cast<char>(bytes.back() + 1);
    write_bytes(path, bytes);
    fs::last_write_time(path, time);
  }
};

TEST_F(ImportChanges, OfEveryFormatAreTold) {
  ImportOptions raw = options("v.raw");
  raw.raw = RawSpec{{6, 5, 4}, ScalarType::kU8, ByteOrder::kLittle, 0};
  const auto write_raw = [&] { write_bytes(in("v.raw"), std::string(120, 'a')); };
  write_raw();
  expect_told(raw, "v.raw", [&] { write_bytes(in("v.raw"), std::string(150, 'a')); });
  write_raw();
  expect_told(raw, "other bytes", [&] { patch_quietly(in("v.raw")); });
  write_raw();
  expect_told(raw, "it is gone", [&] { fs::remove(in("v.raw")); });
  write_raw();
  expect_told(raw, "another file has its name", [&] {
    write_bytes(in("copy"), bytes_of(in("v.raw")));
    fs::rename(in("copy"), in("v.raw"));
  });
  write_raw();
  expect_told(raw, "it was written to",
              [&] { fs::last_write_time(in("v.raw"), fs::last_write_time(in("v.raw")) + std::chrono::seconds(3)); });

  write_bytes(in("v.nhdr"), "NRRD0005\ntype: uint8\ndimension: 3\nsizes: 6 5 4\nencoding: raw\ndata file: v.raw\n\n");
  write_raw();
  expect_told(options("v.nhdr"), "v.raw", [&] { patch_quietly(in("v.raw")); });

  fs::create_directory(in("slices"));
  testing_tools::TiffFixture tiff;
  tiff.width = 3;
  tiff.height = 2;
  for (const char* name : {"a1.tif", "a2.tif", "a3.tif"})
    write_bytes(in("slices") / name, tiff.bytes({{1, 2, 3, 4, 5, 6}}));
  expect_told(options("slices"), "a2.tif", [&] { patch_quietly(in("slices") / "a2.tif"); });

  { testing_tools::Hdf5Fixture(in("v.h5")).array("/v", {2, 3, 4}, std::vector<double>(24, 1.0)); }
  expect_told(options("v.h5"), "v.h5", [&] { patch_quietly(in("v.h5")); });
}

}  // namespace
}  // namespace dubsar
