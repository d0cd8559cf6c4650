// HDF5 volumes of every layout, type and byte order against the values they were made of.

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/hdf5/hdf5_file.h"
#include "core/volume/formats/import.h"
#include "tests/core/volume/hdf5_fixture.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;
using testing_tools::Hdf5Fixture;
using testing_tools::Packing;
using testing_tools::Shape;

class ImportHdf5 : public testing_tools::TempFolder {};

const Shape kShape{5, 6, 7};  // z, y, x

std::vector<double> values_of(const Shape& shape, double first = 0.0, double step = 1.0) {
  std::size_t count = 1;
  for (const auto n : shape) count *= n;
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = first + step * static_cast<double>(i % 120);
  return values;
}

Result<std::unique_ptr<ImportedVolume>> open(const std::filesystem::path& path) {
  ImportOptions options;
  options.path = path;
  return open_volume(options);
}

std::vector<float> read_whole(SlabSource& source, std::int64_t slab = 2) {
  const Dims dims = source.dims();
  std::vector<float> all(static_cast<std::size_t>(dims.count()));
  for (std::int64_t z = 0; z < dims.z; z += slab) {
    const auto end = std::min(dims.z, z + slab);
    const auto result = source.read(z, end,
                                    std::span(all).subspan(static_cast<std::size_t>(z * dims.slice()),
                                                           static_cast<std::size_t>((end - z) * dims.slice())));
    EXPECT_TRUE(result) << result.error().message;
  }
  return all;
}

void expect_values(const std::filesystem::path& path, const std::vector<double>& values, const std::string& what) {
  const auto volume = open(path);
  ASSERT_TRUE(volume) << what << ": " << volume.error().message;
  const auto read = read_whole(**volume);
  ASSERT_EQ(read.size(), values.size()) << what;
  for (std::size_t i = 0; i < read.size(); ++i)
    ASSERT_EQ(read[i], static_cast<float>(values[i])) << what << " at " << i;
}

TEST_F(ImportHdf5, EveryTypeAndByteOrderIsRead) {
  for (int t = 0; t <= static_cast<int>(ScalarType::kF64); ++t) {
    const auto type = static_cast<ScalarType>(t);
    if (type == ScalarType::kF16) continue;  // the library has no such type
    for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig})
      for (const bool chunked : {false, true}) {
        const std::string what = fmt::format("{} {} {}", scalar_name(type), order_name(order), chunked);
        const bool is_signed = type == ScalarType::kI8 || type == ScalarType::kI16 || type == ScalarType::kI32 ||
                               type == ScalarType::kI64 || is_float(type);
        auto values = values_of(kShape, is_signed ? -60.0 : 0.0, is_float(type) ? 1.25 : 1.0);
        if (type == ScalarType::kU16 || type == ScalarType::kU32 || type == ScalarType::kU64) values[3] = 65535.0;
        if (type == ScalarType::kU32 || type == ScalarType::kU64) values[4] = 4294967040.0;
        if (type == ScalarType::kI64) values[5] = -9007199254740992.0;
        Packing packing;
        if (chunked) packing = {.chunk = {2, 4, 4}, .deflate = 4, .shuffle = true};
        { Hdf5Fixture(in("a.h5")).array("/volume", type, order, kShape, values, packing); }
        expect_values(in("a.h5"), values, what);
        const auto volume = open(in("a.h5"));
        EXPECT_EQ((*volume)->info().stored.dtype, scalar_name(type));
        if (scalar_bytes(type) > 1) {
          EXPECT_EQ((*volume)->info().stored.byte_order, order_name(order)) << what;
        }
      }
  }
}

TEST_F(ImportHdf5, EveryLayoutIsRead) {
  const std::vector<std::pair<std::string, Packing>> packings{
      {"contiguous", {}},
      {"compact", {.compact = true}},
      {"chunked", {.chunk = {2, 3, 4}}},
      {"deflate", {.chunk = {5, 6, 7}, .deflate = 9}},
      {"shuffle", {.chunk = {1, 6, 7}, .shuffle = true}},
      {"shuffle deflate", {.chunk = {2, 2, 2}, .deflate = 1, .shuffle = true}},
      {"fletcher32", {.chunk = {3, 3, 3}, .fletcher32 = true}},
      {"shuffle deflate fletcher32", {.chunk = {3, 5, 2}, .deflate = 5, .shuffle = true, .fletcher32 = true}},
      {"lzf", {.chunk = {2, 4, 4}, .foreign_filter = 32000}},
      {"shuffle lzf", {.chunk = {2, 4, 4}, .shuffle = true, .foreign_filter = 32000}},
      {"chunks larger than the volume", {.chunk = {5, 6, 7}, .deflate = 2}},
  };
  const auto values = values_of(kShape, -3.0, 0.5);
  for (const std::uint64_t user_block : {0, 512})
    for (const auto& [what, packing] : packings) {
      {
        Hdf5Fixture(in("a.h5"), user_block).array("/v", ScalarType::kF32, ByteOrder::kLittle, kShape, values, packing);
      }
      expect_values(in("a.h5"), values, fmt::format("{}, user block {}", what, user_block));
    }
  { Hdf5Fixture(in("a.h5")).twelve_bits("/v", kShape, values_of(kShape)); }
  expect_values(in("a.h5"), values_of(kShape), "12 bits in 16");
}

TEST_F(ImportHdf5, ADamagedChunkIsRefusedAndNotDecodedToGarbage) {
  const auto values = values_of(kShape);
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", ScalarType::kF32, ByteOrder::kLittle, kShape, values,
               {.chunk = {5, 6, 7}, .deflate = 5, .fletcher32 = true});
  }
  auto bytes = bytes_of(in("a.h5"));
  const auto zlib = bytes.find("\x78\x5e");  // the head of a zlib stream of level 5
  ASSERT_NE(zlib, std::string::npos);
  bytes[zlib + 40] = static_cast<char>(bytes[zlib + 40] ^ 16);
  write_bytes(in("b.h5"), bytes);
  const auto volume = open(in("b.h5"));
  ASSERT_TRUE(volume) << volume.error().message;
  std::vector<float> out(values.size());
  const auto read = (*volume)->read(0, 5, out);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(read.error().message, HasSubstr("cannot be decoded"));
}

TEST_F(ImportHdf5, UnitAxesAreDropped) {
  const auto values = values_of(kShape);
  for (const Shape& shape : {Shape{1, 5, 6, 7}, Shape{5, 6, 7, 1}, Shape{1, 5, 6, 7, 1}, Shape{5, 1, 6, 7}}) {
    for (const bool chunked : {false, true}) {
      Packing packing;
      if (chunked) {
        packing.deflate = 3;
        for (const auto n : shape) packing.chunk.push_back(n == 1 ? 1 : 3);
      }
      { Hdf5Fixture(in("a.h5")).array("/v", ScalarType::kI16, ByteOrder::kBig, shape, values, packing); }
      expect_values(in("a.h5"), values, fmt::format("rank {}", shape.size()));
    }
  }
}

TEST_F(ImportHdf5, ScaleAndOffsetAttributesAreApplied) {
  const auto stored = values_of(kShape);
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", ScalarType::kU8, ByteOrder::kLittle, kShape, stored);
    file.attribute("/v", "scale_factor", std::vector{0.25});
    file.attribute("/v", "add_offset", std::vector{-8.0});
  }
  auto expected = stored;
  for (double& value : expected) value = value * 0.25 - 8.0;
  expect_values(in("a.h5"), expected, "scaled");
  {
    Hdf5Fixture file(in("b.h5"));
    file.array("/v", ScalarType::kU8, ByteOrder::kLittle, kShape, stored);
    file.attribute("/v", "scale_factor", std::vector{0.0});
  }
  EXPECT_EQ(open(in("b.h5")).error().kind, ErrorKind::kBadData);
}

// ------------------------------------------------------------------------------------------- which dataset is taken

struct Expected {
  std::string dataset, found_by;
};

class ImportHdf5Search : public testing_tools::TempFolder {
 protected:
  void expect_found(const std::string& dataset, const std::string& found_by, const std::string& named = "") {
    ImportOptions options;
    options.path = in("a.h5");
    options.dataset = named;
    const auto volume = open_volume(options);
    ASSERT_TRUE(volume) << volume.error().message;
    EXPECT_EQ((*volume)->info().dataset, dataset);
    EXPECT_EQ((*volume)->info().found_by, found_by);
  }
  const std::vector<double> small_ = values_of({3, 3, 3}), large_ = values_of({6, 6, 6});
};

TEST_F(ImportHdf5Search, NexusDefaultLeadsToTheSignal) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/entry/data/attenuation", {3, 3, 3}, small_);
    file.array("/entry/raw", {6, 6, 6}, large_);
    file.attribute("/", "default", "entry");
    file.attribute("/entry", "default", "data");
    file.attribute("/entry/data", "NX_class", "NXdata");
    file.attribute("/entry/data", "signal", "attenuation");
  }
  expect_found("/entry/data/attenuation", "NeXus default");
  expect_found("/entry/raw", "named by the user", "/entry/raw");
  expect_found("/entry/data/attenuation", "largest array of the named group", "/entry/data");
  ImportOptions options;
  options.path = in("a.h5").string() + ":/entry/raw";
  const auto volume = open_volume(options);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ((*volume)->info().dataset, "/entry/raw");
}

TEST_F(ImportHdf5Search, TomoprocNabuExchangeAndVtkAreKnown) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.text("/scan/definition", "NXtomoproc");
    file.array("/scan/data/data", {3, 3, 3}, small_);
    file.array("/scan/other", {6, 6, 6}, large_);
  }
  expect_found("/scan/data/data", "NeXus NXtomoproc");
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/entry0000/reconstruction/results/data", {3, 3, 3}, small_);
    file.array("/other", {6, 6, 6}, large_);
  }
  expect_found("/entry0000/reconstruction/results/data", "nabu reconstruction");
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/exchange/data", {3, 3, 3}, small_);
    file.array("/exchange/data_white", {6, 6, 6}, large_);
  }
  expect_found("/exchange/data", "Data Exchange");
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/VTKHDF/PointData/ct", {3, 3, 3}, small_);
    file.array("/other", {6, 6, 6}, large_);
    file.attribute("/VTKHDF", "Type", "ImageData");
    file.attribute("/VTKHDF", "Spacing", std::vector{0.1, 0.2, 0.3});
  }
  expect_found("/VTKHDF/PointData/ct", "VTKHDF ImageData");
  const auto volume = open(in("a.h5"));
  EXPECT_EQ((*volume)->info().voxel.mm, glm::dvec3(0.1, 0.2, 0.3));
}

TEST_F(ImportHdf5Search, TheFinestLevelOfAPyramidIsTaken) {
  for (const char* pattern :
       {"/t00000/s00/{}/cells", "/s{}", "/DataSet/ResolutionLevel {}/TimePoint 0/Channel 0/Data"}) {
    {
      Hdf5Fixture file(in("a.h5"));
      file.array(fmt::format(fmt::runtime(pattern), 0), {8, 8, 8}, values_of({8, 8, 8}));
      file.array(fmt::format(fmt::runtime(pattern), 1), {8, 6, 6}, values_of({8, 6, 6}));
      file.array(fmt::format(fmt::runtime(pattern), 2), {4, 2, 2}, values_of({4, 2, 2}));
    }
    const bool imaris = std::string_view(pattern).starts_with("/DataSet/");
    expect_found(fmt::format(fmt::runtime(pattern), 0), imaris ? "Imaris" : "largest array");
    EXPECT_EQ((*open(in("a.h5")))->info().candidates.size(), 2u);
  }
}

TEST_F(ImportHdf5Search, LinksInsideTheFileAreFollowedAndCountOnce) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/deep/er/volume", {6, 6, 6}, large_);
    file.hard_link("/same", "/deep/er/volume");
    file.soft_link("/soft", "/deep/er");
    file.soft_link("/loop", "/loop");
  }
  expect_found("/deep/er/volume", "largest array");
  expect_found("/soft/volume", "named by the user", "/soft/volume");
}

// -------------------------------------------------------------------------------------------------------- voxel size

class ImportHdf5VoxelSize : public testing_tools::TempFolder {
 protected:
  VoxelSize voxel() {
    const auto volume = open(in("a.h5"));
    EXPECT_TRUE(volume) << volume.error().message;
    warnings_ = fmt::format("{}", fmt::join((*volume)->info().warnings, "; "));
    return (*volume)->info().voxel;
  }
  std::string warnings_;
};

TEST_F(ImportHdf5VoxelSize, IsTakenFromAxesWithUnits) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/data/v", kShape, values_of(kShape));
    for (const auto& [name, length, step] :
         {std::tuple("z", 5, 30.0), std::tuple("y", 6, 20.0), std::tuple("x", 7, 10.0)}) {
      std::vector<double> positions;
      for (int i = 0; i < length; ++i) positions.push_back(5.0 + step * i);
      file.array(fmt::format("/data/{}", name), ScalarType::kF64, ByteOrder::kLittle,
                 {static_cast<std::uint64_t>(length)}, positions);
      file.attribute(fmt::format("/data/{}", name), "units", "um");
    }
    file.attribute("/data/v", "axes", "z:y:x");
  }
  const VoxelSize size = voxel();
  EXPECT_NEAR(size.mm.x, 0.01, 1e-12);
  EXPECT_NEAR(size.mm.y, 0.02, 1e-12);
  EXPECT_NEAR(size.mm.z, 0.03, 1e-12);
  EXPECT_EQ(size.provenance, "/data axes z, y, x");
  EXPECT_EQ(warnings_, "");
}

TEST_F(ImportHdf5VoxelSize, IsTakenFromNamesWithUnitsAndNeverWithout) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", kShape, values_of(kShape));
    file.attribute("/v", "element_size_um", std::vector{30.0, 20.0, 10.0});
  }
  EXPECT_EQ(voxel().mm, glm::dvec3(10.0 * 1e-3, 20.0 * 1e-3, 30.0 * 1e-3));
  EXPECT_EQ(voxel().provenance, "/v@element_size_um");
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/g/v", kShape, values_of(kShape));
    file.array("/g/voxel_size", ScalarType::kF64, ByteOrder::kLittle, {1}, {0.05});
    file.attribute("/g/voxel_size", "units", "mm");
  }
  EXPECT_EQ(voxel().mm, glm::dvec3(0.05));
  EXPECT_EQ(voxel().provenance, "/g/voxel_size");
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", kShape, values_of(kShape));
    file.attribute("/v", "voxel_size", std::vector{38.0});
    file.attribute("/v", "units", "counts");
  }
  EXPECT_FALSE(voxel().known());
  EXPECT_THAT(warnings_, HasSubstr("\"/v@voxel_size\" is not used as voxel size: it has no unit of length"));
  EXPECT_THAT(warnings_, HasSubstr("voxel size unknown"));
}

TEST_F(ImportHdf5VoxelSize, OutsideTheWindowOfScannersWarns) {
  for (const auto& [um, warns] :
       {std::pair(0.4, true), std::pair(0.5, false), std::pair(1000.0, false), std::pair(1100.0, true)}) {
    {
      Hdf5Fixture file(in("a.h5"));
      file.array("/v", kShape, values_of(kShape));
      file.attribute("/v", "element_size_um", std::vector{um});
    }
    EXPECT_TRUE(voxel().known());
    EXPECT_EQ(warnings_.find("is the unit right?") != std::string::npos, warns) << um;
  }
}

TEST_F(ImportHdf5VoxelSize, OfTheUserWins) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/v", kShape, values_of(kShape));
    file.attribute("/v", "element_size_um", std::vector{10.0});
  }
  ImportOptions options;
  options.path = in("a.h5");
  options.voxel_size_mm = glm::dvec3(0.038);
  const auto volume = open_volume(options);
  ASSERT_TRUE(volume);
  EXPECT_EQ((*volume)->frame().input_voxel.mm, glm::dvec3(0.038));
  EXPECT_EQ((*volume)->frame().input_voxel.provenance, "given by the user");
}

}  // namespace
}  // namespace dubsar
