// Volumes as netCDF, Imaris, ImageJ, OME and tifffile write them.

#include <fcntl.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <cmath>

#include "core/volume/formats/import.h"
#include "tests/core/image_io/tiff_fixture.h"
#include "tests/core/volume/hdf5_fixture.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing_tools::Hdf5Fixture;
using testing_tools::TiffFixture;

class ImportWorld : public testing_tools::TempFolder {
 protected:
  Result<OpenedVoxels> open(const std::string& name) {
    ImportOptions options;
    options.path = in(name);
    return open_voxels(options);
  }
  /// All voxels, NaN where there is no measurement.
  static std::vector<float> all(OpenedVoxels& opened) {
    const Dims dims = opened.reader->dims();
    const NumberFormat& format = opened.reader->format();
    std::vector<std::byte> stored(static_cast<std::size_t>(dims.count() * scalar_bytes(format.type)));
    const auto read = opened.reader->read({{0, dims.x, 1}, {0, dims.y, 1}, {0, dims.z, 1}}, stored);
    EXPECT_TRUE(read) << read.error().message;
    std::vector<float> out(static_cast<std::size_t>(dims.count()));
    scalars_to_float(stored.data(), format.type, format.order, format.map, out);
    return out;
  }
  static std::string warnings(const OpenedVoxels& opened) {
    return fmt::format("{}", fmt::join(opened.info.warnings, "; "));
  }
  void expect_refused(const std::string& name, ErrorKind kind, const std::string& words) {
    const auto opened = open(name);
    ASSERT_FALSE(opened) << name;
    EXPECT_EQ(opened.error().kind, kind) << opened.error().message;
    EXPECT_THAT(opened.error().message, HasSubstr(words));
  }
};

std::vector<double> ramp(int count) {
  std::vector<double> out(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) out[static_cast<std::size_t>(i)] = i;
  return out;
}

TEST_F(ImportWorld, ValuesThatAreNoMeasurementAreNaN) {
  {
    Hdf5Fixture file(in("a.nc"));
    file.array("/v", ScalarType::kI16, ByteOrder::kLittle, {2, 3, 4}, ramp(24));
    file.integers("/v", "_FillValue", {0});
    file.integers("/v", "missing_value", {5, 7});
    file.integers("/v", "valid_range", {0, 20});
    file.attribute("/v", "scale_factor", std::vector<double>{5.0});
    file.attribute("/v", "add_offset", std::vector<double>{-3.0});
  }
  auto opened = open("a.nc");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(opened->info.stored.may_have_nonfinite);
  const auto values = all(*opened);
  for (int i = 0; i < 24; ++i)
    if (i == 0 || i == 5 || i == 7 || i > 20)
      EXPECT_TRUE(std::isnan(values[static_cast<std::size_t>(i)])) << i;
    else
      EXPECT_EQ(values[static_cast<std::size_t>(i)], 5.0F * static_cast<float>(i) - 3.0F) << i;
}

TEST_F(ImportWorld, SignedNumbersThatAreMeantUnsignedAreReadAsSuch) {
  std::vector<double> stored = ramp(24);  // 0 to 23, meant as 65536 - 12 .. 65535, 0 .. 11
  for (double& value : stored) value -= 12.0;
  for (const bool chunked : {false, true}) {
    const std::string name = chunked ? "chunks.nc" : "plain.nc";
    {
      Hdf5Fixture file(in(name));
      if (chunked)
        file.array("/v", ScalarType::kI16, ByteOrder::kLittle, {2, 3, 4}, stored, {.chunk = {1, 3, 4}});
      else
        file.array("/v", ScalarType::kI16, ByteOrder::kLittle, {2, 3, 4}, stored);
      file.attribute("/v", "_Unsigned", std::string("true"));
      file.integers("/v", "_FillValue", {-1});
    }
    auto opened = open(name);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(opened->info.stored.dtype, "uint16");
    const auto values = all(*opened);
    for (int i = 0; i < 24; ++i)
      if (i == 11)
        EXPECT_TRUE(std::isnan(values[11]));
      else
        EXPECT_EQ(values[static_cast<std::size_t>(i)], static_cast<float>(i < 12 ? 65536 - 12 + i : i - 12)) << i;
  }
}

TEST_F(ImportWorld, LimitsAreOfStoredNumbersOrOfWhatTheyMean) {
  const auto nan_count = [&](const char* name, ScalarType type, const auto& say) {
    {
      Hdf5Fixture file(in(name));
      file.array("/v", type, ByteOrder::kBig, {2, 3, 4}, ramp(24));
      say(file);
    }
    auto opened = open(name);
    EXPECT_TRUE(opened) << opened.error().message;
    const auto values = all(*opened);
    return std::count_if(values.begin(), values.end(), [](float v) { return std::isnan(v); });
  };
  // Floats as limits of packed whole numbers are those of the unpacked ones: 2 * stored + 1 within 5 and 21.
  EXPECT_EQ(nan_count("packed.h5", ScalarType::kU16,
                      [](Hdf5Fixture& file) {
                        file.attribute("/v", "scale_factor", std::vector<double>{2.0});
                        file.attribute("/v", "add_offset", std::vector<double>{1.0});
                        file.attribute("/v", "valid_range", std::vector<double>{5.0, 21.0});
                      }),
            24 - 9);
  EXPECT_EQ(nan_count("floats.h5", ScalarType::kF32,
                      [](Hdf5Fixture& file) {
                        file.attribute("/v", "valid_min", std::vector<double>{3.0});
                        file.attribute("/v", "_FillValue", std::vector<double>{10.0});
                      }),
            3 + 1);
  EXPECT_EQ(nan_count("plain.h5", ScalarType::kU8, [](Hdf5Fixture&) {}), 0);
  // A float's own value of a constant that it cannot hold exactly.
  EXPECT_EQ(
      nan_count("tenth.h5", ScalarType::kF32,
                [](Hdf5Fixture& file) {
                  file.array("/w", ScalarType::kF32, ByteOrder::kLittle, {2, 2, 2}, {1e20, 1e20, 1, 1, 1, 1, 1, 1});
                  file.attribute("/w", "missing_value", std::vector<double>{1e20});
                  file.attribute("/v", "nodata", std::vector<double>{2.0});
                }),
      1);
}

TEST_F(ImportWorld, DimensionScalesGiveVoxelSizeAndOrder) {
  const auto make = [&](const std::string& name, const std::string& unit, const std::array<std::string, 3>& names,
                        bool falling) {
    Hdf5Fixture file(in(name));
    file.group("/scan");
    file.array("/scan/v", {2, 3, 4}, ramp(24));
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> places = ramp(2 + axis);
      for (double& place : places) place *= 50.0 + 10.0 * axis;
      if (falling && axis == 1) std::reverse(places.begin(), places.end());
      const std::string scale = (axis == 0 ? "/" : "/scan/") + names[static_cast<std::size_t>(axis)];
      file.array(scale, {static_cast<std::uint64_t>(2 + axis)}, places);
      file.attribute(scale, "units", unit);
      file.dimension_scale(scale, "/scan/v", axis);
    }
  };
  make("zyx.nc", "um", {"z", "y", "x"}, false);
  auto opened = open("zyx.nc");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_NEAR(opened->info.voxel.mm.x, 0.07, 1e-9);
  EXPECT_NEAR(opened->info.voxel.mm.y, 0.06, 1e-9);
  EXPECT_NEAR(opened->info.voxel.mm.z, 0.05, 1e-9);
  EXPECT_THAT(opened->info.voxel.provenance, HasSubstr("dimension scales /z, /scan/y, /scan/x"));
  EXPECT_EQ(opened->info.axes.letters(), "zyx");
  make("xyz.nc", "1e-6 m", {"x", "y", "z"}, false);
  opened = open("xyz.nc");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->info.axes.letters(), "xyz");
  EXPECT_NEAR(opened->info.voxel.mm.x, 0.05, 1e-9) << "the slowest axis is x";
  make("falls.nc", "angstrom", {"z", "y", "x"}, true);
  opened = open("falls.nc");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->info.axes.letters(), "z-yx");
  EXPECT_NEAR(opened->info.voxel.mm.y, 60e-7, 1e-12);
  make("pixels.nc", "pixel", {"z", "y", "x"}, false);
  opened = open("pixels.nc");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_FALSE(opened->info.voxel.known());
}

TEST_F(ImportWorld, ImarisVolumesAreWithoutTheirPadding) {
  const auto make = [&](const std::string& name, int channels, const std::string& size_x, int backwards = -1) {
    Hdf5Fixture file(in(name));
    const std::string point = "/DataSet/ResolutionLevel 0/TimePoint 0";
    for (const char* group : {"/DataSet", "/DataSet/ResolutionLevel 0", "/DataSetInfo", "/DataSetInfo/Image"})
      file.group(group);
    file.group(point);
    for (int c = 0; c < channels; ++c) {
      const std::string channel = point + "/Channel " + std::to_string(c);
      file.group(channel);
      file.array(channel + "/Data", ScalarType::kU16, ByteOrder::kLittle, {4, 4, 8}, ramp(128),
                 {.chunk = {2, 2, 4}, .deflate = 1});
      file.characters(channel, "ImageSizeX", size_x);
      file.characters(channel, "ImageSizeY", "3");
      file.characters(channel, "ImageSizeZ", "3");
    }
    for (int axis = 0; axis < 3; ++axis) {
      file.characters("/DataSetInfo/Image", std::string(1, "XYZ"[axis]), axis == 0 ? size_x : "3");
      file.characters("/DataSetInfo/Image", "ExtMin" + std::to_string(axis), axis == backwards ? "20.5" : "-10");
      file.characters("/DataSetInfo/Image", "ExtMax" + std::to_string(axis), axis == backwards ? "-10" : "20.5");
    }
    file.characters("/DataSetInfo/Image", "Unit", "um");
  };
  make("a.ims", 1, "5");
  auto opened = open("a.ims");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->info.file_dims, (Dims{5, 3, 3}));
  EXPECT_EQ(opened->info.found_by, "Imaris");
  EXPECT_NEAR(opened->info.voxel.mm.x, 30.5e-3 / 5, 1e-9);
  EXPECT_NEAR(opened->info.voxel.mm.y, 30.5e-3 / 3, 1e-9);
  const auto values = all(*opened);
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x)
        EXPECT_EQ(values[static_cast<std::size_t>((z * 3 + y) * 5 + x)], static_cast<float>((z * 4 + y) * 8 + x));
  EXPECT_FALSE(opened->info.axes.known());
  for (int axis = 0; axis < 3; ++axis) {  // stored from its far end, or the surface would be a mirror image
    const std::string name = "flipped" + std::to_string(axis) + ".ims";
    make(name, 1, "5", axis);
    opened = open(name);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(opened->info.axes.letters(), (std::array{"zy-x", "z-yx", "-zyx"})[static_cast<std::size_t>(axis)]);
    EXPECT_EQ(opened->info.file_dims, (Dims{5, 3, 3}));
    EXPECT_NEAR(opened->info.voxel.mm.x, 30.5e-3 / 5, 1e-9);
  }
  make("wrong.ims", 1, "9");
  opened = open("wrong.ims");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->info.file_dims, (Dims{8, 4, 4})) << "a size that the array does not have is not believed";
  make("two.ims", 2, "5");
  expect_refused("two.ims", ErrorKind::kBadData, "Channel 1/Data");
}

TEST_F(ImportWorld, ALockedFileIsCalledLocked) {
  { Hdf5Fixture(in("v.h5")).array("/v", {2, 3, 4}, ramp(24)); }
  const int writer = ::open(in("v.h5").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  expect_refused("v.h5", ErrorKind::kTryAgain, "v.h5 is locked: another program has it open for writing");
  ::flock(writer, LOCK_UN);
  EXPECT_TRUE(open("v.h5"));
  ::close(writer);
}

TEST_F(ImportWorld, ImageJStacksOfOnePageMayHaveLargeSlices) {
  for (const bool big : {false, true})
    for (const int photometric : {1, 0}) {
      TiffFixture tiff;
      tiff.width = 120;
      tiff.height = 50;  // 12,000 bytes a slice: the library cuts single strips above 8 KiB into several
      tiff.bits = 16;
      tiff.big_endian = big;
      tiff.photometric = photometric;
      tiff.description = "ImageJ=1.53t\nimages=3\nslices=3\nunit=mm\nspacing=0.05\nloop=false\n";
      const auto sample = [](std::int64_t i) { return static_cast<std::uint64_t>(i * 7 % 65536); };
      std::vector<std::uint64_t> first;
      for (std::int64_t i = 0; i < 6000; ++i) first.push_back(sample(i));
      for (std::int64_t i = 6000; i < 18000; ++i)
        for (int k = 0; k < 2; ++k) tiff.trailing += static_cast<char>(sample(i) >> 8 * (big ? 1 - k : k));
      write_bytes(in("stack.tif"), tiff.bytes({first}));
      auto opened = open("stack.tif");
      ASSERT_TRUE(opened) << opened.error().message;
      EXPECT_EQ(opened->info.file_dims, (Dims{120, 50, 3}));
      EXPECT_NEAR(opened->info.voxel.mm.z, 0.05, 1e-12);
      const auto values = all(*opened);
      for (std::int64_t i = 0; i < 18000; ++i) {
        const auto stored = static_cast<float>(sample(i));
        ASSERT_EQ(values[static_cast<std::size_t>(i)], photometric == 0 ? 65535.0F - stored : stored) << i;
      }
    }
}

TEST_F(ImportWorld, RowsAndColumnsBeginWhereTheOrientationSays) {
  for (int orientation = 1; orientation <= 8; ++orientation) {
    TiffFixture tiff;
    tiff.width = 3;
    tiff.height = 2;
    tiff.orientation = orientation;
    tiff.oriented_once = orientation % 2 == 0;  // as tifffile writes it
    write_bytes(in("o.tif"), tiff.bytes({{0, 1, 2, 3, 4, 5}, {6, 7, 8, 9, 10, 11}}));
    auto opened = open("o.tif");
    ASSERT_TRUE(opened) << opened.error().message;
    const bool turned = orientation >= 5;
    ASSERT_EQ(opened->info.file_dims, (turned ? Dims{2, 3, 2} : Dims{3, 2, 2})) << orientation;
    // TIFF 6.0, tag 274: what the 0th row and the 0th column of the file are of what is seen.
    const auto seen = [&](int row, int column) {
      switch (orientation) {
        case 2:
          return std::pair{2 - column, row};
        case 3:
          return std::pair{2 - column, 1 - row};
        case 4:
          return std::pair{column, 1 - row};
        case 5:
          return std::pair{row, column};
        case 6:
          return std::pair{1 - row, column};
        case 7:
          return std::pair{1 - row, 2 - column};
        case 8:
          return std::pair{row, 2 - column};
        default:
          return std::pair{column, row};
      }
    };
    const auto values = all(*opened);
    const int width = turned ? 2 : 3;
    for (int z = 0; z < 2; ++z)
      for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 3; ++column) {
          const auto [x, y] = seen(row, column);
          EXPECT_EQ(values[static_cast<std::size_t>(z * 6 + y * width + x)],
                    static_cast<float>(z * 6 + row * 3 + column))
              << orientation;
        }
    EXPECT_EQ(opened->info.axes.provenance, orientation > 1 ? fmt::format("TIFF orientation {}", orientation) : "");
  }
}

TEST_F(ImportWorld, ChannelsAndTimesAreNoSlices) {
  const auto make = [&](const std::string& description) {
    TiffFixture tiff;
    tiff.width = 3;
    tiff.height = 2;
    tiff.description = description;
    write_bytes(in("s.tif"),
                tiff.bytes({{1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}}));
  };
  for (const char* text : {"<OME><Pixels SizeZ=\"2\" SizeC=\"2\" SizeT=\"1\"/></OME>",
                           R"({"shape": [2, 2, 2, 3], "axes": "TZYX"})", "ImageJ=1\nimages=4\nframes=2\nslices=2\n"}) {
    make(text);
    expect_refused("s.tif", ErrorKind::kBadData, "several channels or time points (2 ");
  }
  make(
      "<OME><Pixels SizeZ=\"4\" PhysicalSizeX=\"50\" PhysicalSizeY=\"60\" PhysicalSizeZ=\"0.1\" "
      "PhysicalSizeZUnit=\"mm\"/></OME>");
  auto opened = open("s.tif");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_NEAR(opened->info.voxel.mm.x, 0.05, 1e-12);
  EXPECT_NEAR(opened->info.voxel.mm.y, 0.06, 1e-12);
  EXPECT_NEAR(opened->info.voxel.mm.z, 0.1, 1e-12);
  make("<OME><Pixels SizeZ=\"9\"/></OME>");
  opened = open("s.tif");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_THAT(warnings(*opened), HasSubstr("says 9 slices, 4 are here"));
}

TEST_F(ImportWorld, AFileThatIsCalledASliceAndIsNoneIsRefused) {
  TiffFixture tiff;
  tiff.width = 3;
  tiff.height = 2;
  for (const char* name : {"r/a1.tif", "r/a2.tif", "r/a3.tif"}) {
    fs::create_directories(in(name).parent_path());
    write_bytes(in(name), tiff.bytes({{1, 2, 3, 4, 5, 6}}));
  }
  write_bytes(in("r/notes.txt"), {});
  write_bytes(in("r/._a1.tif"), {});
  EXPECT_TRUE(open("r"));
  for (const char* name : {"r/a2.tif", "r/a3.TIFF"}) {  // within, and behind the last
    write_bytes(in(name), {});
    expect_refused("r", ErrorKind::kBadData,
                   fmt::format("{} is empty, expected a slice", fs::path(name).filename().string()));
    write_bytes(in(name), "<html></\n");
    expect_refused("r", ErrorKind::kBadData, "(9 bytes) is no TIFF file");
    write_bytes(in(name), tiff.bytes({{1, 2, 3, 4, 5, 6}}));
  }
}

TEST_F(ImportWorld, AFolderOfTwoSeriesIsRefusedAndAGapIsTold) {
  TiffFixture tiff;
  tiff.width = 3;
  tiff.height = 2;
  const auto slice = [&](const std::string& name) {
    fs::create_directories(in(name).parent_path());
    write_bytes(in(name), tiff.bytes({{1, 2, 3, 4, 5, 6}}));
  };
  for (const char* name : {"two/a_1.tif", "two/a_2.tif", "two/mask_1.tif"}) slice(name);
  expect_refused("two", ErrorKind::kBadData, "a_*.tif (2 files) and mask_*.tif (1 file)");
  ImportOptions one;
  one.path = in("two") / "a_*.tif";
  EXPECT_TRUE(open_voxels(one));
  for (const char* name : {"gap/r1.tif", "gap/r2.tif", "gap/r4.tif", "gap/r5.tif"}) slice(name);
  auto opened = open("gap");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_THAT(warnings(*opened), HasSubstr("1 slice is missing among the names of the files (r3)"));
}

}  // namespace
}  // namespace dubsar
