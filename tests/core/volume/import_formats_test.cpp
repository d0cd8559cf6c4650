// Raw, NRRD and TIFF volumes.

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "core/volume/formats/import.h"
#include "tests/core/image_io/tiff_fixture.h"
#include "tests/core/volume/gzip.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;
using testing_tools::TiffFixture;

constexpr Dims kPictureDims{6, 5, 4};

// The volume 3 * i - 7 in a type and byte order.
template <class T>
std::string stored(bool big_endian) {
  std::string bytes;
  for (int i = 0; i < kPictureDims.count(); ++i) {
    const T value = static_cast<T>(3 * i - 7 * (std::is_signed_v<T> ? 1 : 0));
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.begin(), raw.end());
  }
  return bytes;
}

class ImportFormats : public testing_tools::TempFolder {
 protected:
  Result<std::unique_ptr<ImportedVolume>> open(const std::string& name) {
    ImportOptions options;
    options.path = in(name);
    return open_volume(options);
  }
  void expect_refused(const std::string& name, std::initializer_list<const char*> parts) {
    const auto volume = open(name);
    ASSERT_FALSE(volume) << name;
    EXPECT_EQ(volume.error().kind, ErrorKind::kBadData);
    for (const char* part : parts) EXPECT_THAT(volume.error().message, HasSubstr(part));
  }
  static void expect_ramp(Result<std::unique_ptr<ImportedVolume>> volume, int first, const std::string& what) {
    ASSERT_TRUE(volume) << what << ": " << volume.error().message;
    ASSERT_EQ((*volume)->dims(), kPictureDims) << what;
    std::vector<float> out(static_cast<std::size_t>(kPictureDims.count()));
    for (const std::int64_t z : {2, 0, 3, 1}) {  // any order
      const auto read = (*volume)->read(z, z + 1,
                                        std::span(out).subspan(static_cast<std::size_t>(z * kPictureDims.slice()),
                                                               static_cast<std::size_t>(kPictureDims.slice())));
      ASSERT_TRUE(read) << what << ": " << read.error().message;
    }
    for (int i = 0; i < kPictureDims.count(); ++i)
      ASSERT_EQ(out[static_cast<std::size_t>(i)], static_cast<float>(3 * i + first)) << what;
  }
  static std::string warnings(const ImportedVolume& volume) {
    return fmt::format("{}", fmt::join(volume.info().warnings, "; "));
  }
};

TEST_F(ImportFormats, RawFilesAreReadAsTheUserSays) {
  const auto check = [&]<class T>(T, ScalarType type) {
    for (const bool big : {false, true}) {
      write_bytes(in("a.raw"), "header" + stored<T>(big) + "tail");
      ImportOptions options;
      options.path = in("a.raw");
      options.raw = RawSpec{{6, 5, 4}, type, big ? ByteOrder::kBig : ByteOrder::kLittle, 6};
      const auto volume = open_volume(options);
      ASSERT_TRUE(volume) << volume.error().message;
      EXPECT_THAT(warnings(**volume), HasSubstr("4 bytes follow the voxels"));
      expect_ramp(open_volume(options), std::is_signed_v<T> ? -7 : 0, std::string(scalar_name(type)));
    }
  };
  check(std::int16_t{}, ScalarType::kI16);
  check(std::uint16_t{}, ScalarType::kU16);
  check(std::int32_t{}, ScalarType::kI32);
  check(std::uint32_t{}, ScalarType::kU32);
  check(std::int64_t{}, ScalarType::kI64);
  check(std::uint64_t{}, ScalarType::kU64);
  check(float{}, ScalarType::kF32);
  check(double{}, ScalarType::kF64);
}

TEST_F(ImportFormats, ARawFileThatIsTooSmallSaysBothSizes) {
  write_bytes(in("a.raw"), std::string(100, 'x'));
  ImportOptions options;
  options.path = in("a.raw");
  options.raw = RawSpec{{6, 5, 4}, ScalarType::kU8, ByteOrder::kLittle, 0};
  const auto volume = open_volume(options);
  ASSERT_FALSE(volume);
  EXPECT_EQ(volume.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(volume.error().message, HasSubstr("has 100 bytes, expected 120"));
  options.raw->dims = {1 << 20, 4, 4};
  EXPECT_THAT(open_volume(options).error().message, HasSubstr("expected at most 65535"));
}

constexpr const char* kNrrd =
    "NRRD0005\n# a comment\ntype: {}\ndimension: 3\nsizes: 6 5 4\nendian: {}\nencoding: {}\n{}\n";

TEST_F(ImportFormats, NrrdRawAndGzipAreRead) {
  for (const bool big : {false, true}) {
    const char* const order = big ? "big" : "little";
    write_bytes(in("a.nrrd"), fmt::format(fmt::runtime(kNrrd), "short", order, "raw", "") + stored<std::int16_t>(big));
    expect_ramp(open("a.nrrd"), -7, "raw");
    write_bytes(in("a.nrrd"),
                fmt::format(fmt::runtime(kNrrd), "float", order, "gzip", "") + testing_tools::gzip(stored<float>(big)));
    expect_ramp(open("a.nrrd"), -7, "gzip");
  }
  write_bytes(in("a.nrrd"), fmt::format(fmt::runtime(kNrrd), "double", "little", "raw", "byte skip: 5\n") + "12345" +
                                stored<double>(false));
  expect_ramp(open("a.nrrd"), -7, "byte skip");
  write_bytes(in("a.nrrd"), fmt::format(fmt::runtime(kNrrd), "double", "little", "raw", "byte skip: -1\n") + "1234567" +
                                stored<double>(false));
  expect_ramp(open("a.nrrd"), -7, "from the end");
  write_bytes(in("v.raw"), stored<std::uint16_t>(false));
  write_bytes(in("a.nhdr"), fmt::format(fmt::runtime(kNrrd), "uint16", "little", "raw", "data file: v.raw\n"));
  expect_ramp(open("a.nhdr"), 0, "detached");
}

TEST_F(ImportFormats, NrrdVoxelSizeNeedsAUnit) {
  const auto with = [&](const std::string& fields) {
    write_bytes(in("a.nrrd"),
                fmt::format(fmt::runtime(kNrrd), "short", "little", "raw", fields) + stored<std::int16_t>(false));
    auto volume = open("a.nrrd");
    EXPECT_TRUE(volume) << volume.error().message;
    return std::move(*volume);
  };
  EXPECT_EQ(with("spacings: 10 20 30\nunits: \"um\" \"um\" \"um\"\n")->info().voxel.mm,
            glm::dvec3(10 * 1e-3, 20 * 1e-3, 30 * 1e-3));
  const auto directions =
      with("space dimension: 3\nspace directions: (0,0.3,0.4) (0.25,0,0) (0,0,1)\nspace units: \"mm\" \"mm\" \"mm\"\n");
  EXPECT_EQ(directions->info().voxel.mm.x, 0.25);  // the second stored axis runs along x
  EXPECT_NEAR(directions->info().voxel.mm.y, 0.5, 1e-12);
  const auto medical = with("space: left-posterior-superior\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,1)\n");
  EXPECT_EQ(medical->info().voxel.mm, glm::dvec3(0.5, 0.5, 1.0));
  EXPECT_THAT(warnings(*medical), HasSubstr("millimetres are taken"));
  const auto bare = with("spacings: 10 20 30\n");
  EXPECT_FALSE(bare->info().voxel.known());
  EXPECT_THAT(warnings(*bare), HasSubstr("no unit of length"));
}

TEST_F(ImportFormats, NrrdThatIsNoVolumeIsRefused) {
  const auto write = [&](const std::string& text) { write_bytes(in("a.nrrd"), text); };
  write("NRRD0004\ntype: block\ndimension: 3\nsizes: 6 5 4\nencoding: raw\n\n");
  expect_refused("a.nrrd", {"type \"block\""});
  write("NRRD0004\ntype: short\ndimension: 4\nsizes: 3 6 5 4\nencoding: raw\n\n");
  expect_refused("a.nrrd", {"expected 3 axes"});
  write("NRRD0004\ntype: short\ndimension: 3\nsizes: 6 5 -4\nencoding: raw\n\n");
  expect_refused("a.nrrd", {"whole numbers"});
  write("NRRD0004\ntype: short\ndimension: 3\nsizes: 60000 60000 60000\nencoding: raw\n\n");
  expect_refused("a.nrrd", {"2^36"});
  write("NRRD0004\ntype: short\ndimension: 3\nsizes: 6 5 4\nencoding: bzip2\n\n");
  expect_refused("a.nrrd", {"encoding \"bzip2\", expected raw or gzip"});
  write("NRRD0004\ntype: short\ndimension: 3\nsizes: 6 5 4\nencoding: raw\nendian: little\n\n1234");
  expect_refused("a.nrrd", {"truncated"});
  write("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: /etc/debian_version\n\n");
  expect_refused("a.nrrd", {"outside the allowed folder"});
  write("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: slice%03d.raw 1 2 1\n\n");
  expect_refused("a.nrrd", {"several files"});
}

TEST_F(ImportFormats, EveryNrrdTruncationIsRefused) {
  for (const bool packed : {false, true}) {
    const std::string bytes = fmt::format(fmt::runtime(kNrrd), "short", "little", packed ? "gzip" : "raw", "") +
                              (packed ? testing_tools::gzip(stored<std::int16_t>(false)) : stored<std::int16_t>(false));
    for (std::size_t length = 0; length + 9 < bytes.size(); ++length) {  // the last 8 bytes of gzip are its checksum
      write_bytes(in("a.nrrd"), bytes.substr(0, length));
      const auto volume = open("a.nrrd");
      std::vector<float> out(static_cast<std::size_t>(kPictureDims.count()));
      const auto read = volume ? (*volume)->read(0, 4, out) : tl::unexpected<Error>(volume.error());
      ASSERT_FALSE(read) << length << " of " << bytes.size();
      EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
    }
  }
}

std::vector<std::vector<std::uint64_t>> pages_of(int first) {
  std::vector<std::vector<std::uint64_t>> pages(static_cast<std::size_t>(kPictureDims.z));
  for (int i = 0; i < kPictureDims.count(); ++i)
    pages[static_cast<std::size_t>(i / kPictureDims.slice())].push_back(static_cast<std::uint64_t>(3 * i + first) &
                                                                        0xffff);
  return pages;
}

TEST_F(ImportFormats, TiffPagesFoldersAndPatternsAreStacks) {
  TiffFixture fixture{.width = 6, .height = 5, .bits = 16};
  for (const bool big_tiff : {false, true}) {
    fixture.big_tiff = big_tiff;
    fixture.big_endian = !big_tiff;
    write_bytes(in("stack.tif"), fixture.bytes(pages_of(0)));
    expect_ramp(open("stack.tif"), 0, "pages");
  }
  std::filesystem::create_directories(in("slices"));
  const auto pages = pages_of(0);
  const std::array<const char*, 4> names{"s8.tif", "s9.tif", "s10.tif", "s011.tif"};
  for (std::size_t i = 0; i < 4; ++i) write_bytes(in("slices") / names[i], fixture.bytes({pages[i]}));
  write_bytes(in("slices/scan.log"), "not a slice");
  write_bytes(in("slices/._s8.tif"), fixture.bytes({pages[0]}));
  expect_ramp(open("slices"), 0, "folder");
  write_bytes(in("slices/preview.tif"), TiffFixture{.width = 2, .height = 2, .bits = 8}.bytes({{1, 2, 3, 4}}));
  expect_refused("slices", {"several series of names: preview.tif (1 file) and s*.tif (4 files)", "pattern"});
  std::filesystem::rename(in("slices/preview.tif"), in("slices/s12.tif"));
  expect_refused("slices", {"expected slices of one size", "pattern"});
  std::filesystem::rename(in("slices/s12.tif"), in("slices/preview.tif"));
  expect_ramp(open("slices/s*.tif"), 0, "pattern");
  EXPECT_EQ(open("slices/t*.tif").error().kind, ErrorKind::kNoInput);
}

TEST_F(ImportFormats, ATiffPageMayHoldAVolume) {
  const auto pages = pages_of(0);
  for (const bool big_endian : {false, true}) {
    TiffFixture fixture{.width = 6, .height = 5, .bits = 16, .big_endian = big_endian, .depth = 4};
    for (std::size_t page = 1; page < pages.size(); ++page)
      for (const std::uint64_t sample : pages[page])
        for (int k = 0; k < 2; ++k) fixture.trailing += static_cast<char>(sample >> 8 * (big_endian ? 1 - k : k));
    write_bytes(in("deep.tif"), fixture.bytes({pages[0]}));
    expect_ramp(open("deep.tif"), 0, "deep page");
    // Beside other pages nothing says what belongs together.
    write_bytes(in("deep.tif"), fixture.bytes({pages[0], pages[1]}));
    expect_refused("deep.tif", {"4 slices in one page (ImageDepth, tag 32997)"});
  }
}

TEST_F(ImportFormats, FloatAndSignedTiffSamplesAreRead) {
  std::vector<std::vector<std::uint64_t>> pages = pages_of(-7);
  TiffFixture fixture{.width = 6, .height = 5, .bits = 16, .sample_format = 2};
  write_bytes(in("a.tif"), fixture.bytes(pages));
  expect_ramp(open("a.tif"), -7, "int16");
  for (auto& page : pages)
    for (auto& sample : page)
      sample = std::bit_cast<std::uint32_t>(static_cast<float>(static_cast<std::int16_t>(sample)));
  fixture.bits = 32;
  fixture.sample_format = 3;
  write_bytes(in("a.tif"), fixture.bytes(pages));
  expect_ramp(open("a.tif"), -7, "float32");
}

TEST_F(ImportFormats, TiffVoxelSizeComesFromItsTags) {
  TiffFixture fixture{.width = 6, .height = 5, .bits = 16};
  fixture.x_pixels = 250;
  fixture.unit = 3;
  write_bytes(in("a.tif"), fixture.bytes(pages_of(0)));
  const auto tags = open("a.tif");
  ASSERT_TRUE(tags);
  EXPECT_EQ((*tags)->info().voxel.mm, glm::dvec3(0.04));
  EXPECT_THAT(warnings(**tags), HasSubstr("no slice distance"));
  fixture.x_pixels = 72;
  fixture.unit = 2;
  write_bytes(in("a.tif"), fixture.bytes(pages_of(0)));
  const auto habit = open("a.tif");
  EXPECT_FALSE((*habit)->info().voxel.known());
  EXPECT_THAT(warnings(**habit), HasSubstr("72 dpi"));
  fixture.x_pixels = 20;
  fixture.unit = 1;
  fixture.description = "ImageJ=1.53\nimages=4\nslices=4\nunit=mm\nspacing=0.1\n";
  write_bytes(in("a.tif"), fixture.bytes(pages_of(0)));
  const auto imagej = open("a.tif");
  EXPECT_EQ((*imagej)->info().voxel.mm, glm::dvec3(0.05, 0.05, 0.1));
}

TEST_F(ImportFormats, AnImagejStackBehindOnePageIsReadWhole) {
  TiffFixture fixture{.width = 6, .height = 5, .bits = 16, .big_endian = true};
  fixture.description = "ImageJ=1.53\nimages=4\nslices=4\n";
  const std::string all = stored<std::uint16_t>(true);
  fixture.trailing = all.substr(2 * static_cast<std::size_t>(kPictureDims.slice()));
  write_bytes(in("a.tif"), fixture.bytes({pages_of(0)[0]}));
  expect_ramp(open("a.tif"), 0, "ImageJ");
}

TEST_F(ImportFormats, TiffThatIsNoVolumeIsRefused) {
  TiffFixture fixture{.width = 2, .height = 2, .bits = 8};
  write_bytes(in("a.tif"), fixture.bytes({{1, 2, 3, 4}}));
  expect_refused("a.tif", {"is a single picture", "folder of the slices"});
  fixture.channels = 3;
  fixture.photometric = 2;
  write_bytes(in("a.tif"), fixture.bytes({std::vector<std::uint64_t>(12, 1), std::vector<std::uint64_t>(12, 1)}));
  expect_refused("a.tif", {"is a colour picture (3 channels)"});
}

}  // namespace
}  // namespace dubsar
