// Crop, stride, slabs and NaN: what comes out does not depend on how it is read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/base/system/parallel.h"
#include "core/volume/formats/import.h"
#include "tests/core/volume/temp_folder.h"
#include "tests/core/volume/written_scan.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

class ImportGrid : public testing_tools::TempFolder {
 protected:
  static constexpr Dims kDims{23, 19, 17};

  static std::vector<float> values() {
    std::vector<float> all(static_cast<std::size_t>(kDims.count()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<float>(i);
    return all;
  }
  static float expected(const VoxelBox& box, std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<float>((box.z.at(z) * kDims.y + box.y.at(y)) * kDims.x + box.x.at(x));
  }
  void write(const std::string& name, std::vector<std::uint64_t> chunk, const std::vector<float>& all) {
    Hdf5Storage storage{.dims = {17, 19, 23}, .chunk = std::move(chunk)};
    storage.deflate = storage.chunk.empty() ? 0 : 3;
    test::write_scan(in(name), "/v", storage, all);
  }
  static Result<std::vector<float>> read(SlabSource& source, std::int64_t slab, std::int64_t overlap = 0) {
    const Dims dims = source.dims();
    std::vector<float> all(static_cast<std::size_t>(dims.count()));
    for (std::int64_t z = 0; z < dims.z; z += slab) {
      const auto begin = std::max<std::int64_t>(0, z - overlap), end = std::min(dims.z, z + slab);
      DUBSAR_TRY(source.read(begin, end,
                             std::span(all).subspan(static_cast<std::size_t>(begin * dims.slice()),
                                                    static_cast<std::size_t>((end - begin) * dims.slice()))));
    }
    return all;
  }
};

TEST_F(ImportGrid, CropAndStrideEqualSlicing) {
  write("flat.h5", {}, values());
  write("chunked.h5", {4, 5, 6}, values());
  std::mt19937 random(1);
  for (int trial = 0; trial < 40; ++trial) {
    ImportOptions options;
    options.crop.emplace();
    const std::array<std::int64_t, 3> sizes{kDims.x, kDims.y, kDims.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      options.crop->begin[axis] = static_cast<std::int64_t>(random() % 6);
      options.crop->end[axis] =
          options.crop->begin[axis] + 5 +
          static_cast<std::int64_t>(random() % static_cast<unsigned>(sizes[axis] - options.crop->begin[axis] - 5 + 1));
      options.crop->end[axis] = std::min(options.crop->end[axis], sizes[axis]);
      options.stride[axis] = 1 + static_cast<std::int64_t>(random() % 3);
    }
    if (trial % 4 == 0) options.crop->end[0] = options.crop->begin[0] + 5;  // narrow: row by row
    for (const char* name : {"flat.h5", "chunked.h5"}) {
      options.path = in(name);
      const auto volume = open_volume(options);
      ASSERT_TRUE(volume) << volume.error().message;
      const auto all = read(**volume, 1 + trial % 7);
      ASSERT_TRUE(all) << all.error().message;
      const VoxelBox& box = (*volume)->info().box;
      const Dims dims = (*volume)->dims();
      for (std::int64_t z = 0, i = 0; z < dims.z; ++z)
        for (std::int64_t y = 0; y < dims.y; ++y)
          for (std::int64_t x = 0; x < dims.x; ++x, ++i)
            ASSERT_EQ((*all)[static_cast<std::size_t>(i)], expected(box, x, y, z))
                << name << " " << x << " " << y << " " << z;
      const glm::dvec3 corner = (*volume)->frame().input_vox_from_grid({1, 1, 1});
      EXPECT_EQ(corner, glm::dvec3(box.x.at(1), box.y.at(1), box.z.at(1)));
    }
  }
}

TEST_F(ImportGrid, SlabHeightOverlapAndThreadsChangeNothing) {
  auto all = values();
  std::mt19937 random(2);
  for (int i = 0; i < 60; ++i) all[random() % all.size()] = i % 2 == 0 ? NAN : -INFINITY;
  write("flat.h5", {}, all);
  write("chunked.h5", {5, 8, 8}, all);
  for (const char* name : {"flat.h5", "chunked.h5"}) {
    std::vector<float> reference;
    std::int64_t count = 0;
    for (const auto& [slab, overlap, threads] :
         {std::tuple(17, 0, 1), {1, 0, 2}, {3, 2, 2}, {4, 1, 7}, {5, 0, 2}, {16, 5, 2}}) {
      set_thread_count(threads);
      ImportOptions options;
      options.path = in(name);
      const auto volume = open_volume(options);
      ASSERT_TRUE(volume);
      const auto result = read(**volume, slab, overlap);
      ASSERT_TRUE(result) << result.error().message;
      if (reference.empty()) {
        reference = *result;
        count = (*volume)->unmeasured_counts().nonfinite;
        EXPECT_EQ(count, std::count_if(all.begin(), all.end(), [](float v) { return !std::isfinite(v); }));
      }
      EXPECT_EQ(*result, reference) << name << " slab " << slab;
      EXPECT_EQ((*volume)->unmeasured_counts().nonfinite, count) << name << " slab " << slab;
    }
    set_thread_count(0);
    EXPECT_TRUE(std::all_of(reference.begin(), reference.end(), [](float v) { return std::isfinite(v); }));
  }
}

TEST_F(ImportGrid, NonfiniteVoxelsBecomeAir) {
  // 90 % air of about -1000, 10 % clay of 500 in every slice
  std::vector<float> all(static_cast<std::size_t>(kDims.count()));
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0F, 5.0F);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = (i % 10 == 0 ? 500.0F : -1000.0F) + noise(random);
  all[100] = NAN;
  all[7000] = INFINITY;
  write("a.h5", {}, all);
  ImportOptions options;
  options.path = in("a.h5");
  const auto volume = open_volume(options);
  ASSERT_TRUE(volume);
  const auto result = read(**volume, 4);
  ASSERT_TRUE(result);
  EXPECT_EQ((*volume)->unmeasured_counts().nonfinite, 2);
  const float fill = (*volume)->unmeasured().value().fill;
  EXPECT_NEAR(fill, -1008.0F, 3.0F);
  EXPECT_EQ((*result)[100], fill);
  EXPECT_EQ((*result)[7000], fill);
  EXPECT_EQ((*result)[101], all[101]);
  options.unmeasured_fill = 3.0F;
  const auto filled = read(**open_volume(options), 4);
  EXPECT_EQ((*filled)[100], 3.0F);
}

TEST_F(ImportGrid, MoreThanOnePercentNonfiniteBetweenMeasurementsStops) {
  const auto limit = static_cast<std::size_t>(kDims.count() / 100);
  for (const auto& [bad, good] : {std::pair(limit, true), std::pair(limit + 1, false)}) {
    auto all = values();
    for (std::size_t i = 0; i < bad; ++i)  // in the middle of rows, slice after slice
      all[static_cast<std::size_t>(kDims.x) * i + 11] = std::numeric_limits<float>::quiet_NaN();
    write("a.h5", {}, all);
    ImportOptions options;
    options.path = in("a.h5");
    const auto volume = open_volume(options);
    ASSERT_TRUE(volume);
    const auto result = read(**volume, 3);
    EXPECT_EQ(result.has_value(), good) << bad;
    if (!result) {
      EXPECT_EQ(result.error().kind, ErrorKind::kBadData);
      EXPECT_THAT(result.error().message, HasSubstr("expected at most 1 %"));
    }
  }
  write("a.h5", {}, std::vector<float>(static_cast<std::size_t>(kDims.count()), NAN));
  ImportOptions options;
  options.path = in("a.h5");
  const auto volume = open_volume(options);
  ASSERT_TRUE(volume);
  const auto result = read(**volume, 3);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(result.error().message, HasSubstr("no voxel of 7 slices is a measurement"));
}

// Chunks that reach over what may be kept in memory, with their edges beyond the array, through both ways to decode.
TEST_F(ImportGrid, LayersBeyondTheBudgetComeBackTheSame) {
  write("chunked.h5", {8, 6, 23}, values());
  for (const std::uint64_t memory : {std::uint64_t{1} << 30, std::uint64_t{4000}})
    for (const std::int64_t slab : {1, 3, 8, 17})
      for (const char* stride : {"1", "2,1,3"}) {
        ImportOptions options;
        options.path = in("chunked.h5");
        options.stride = *parse_stride(stride);
        options.budget.memory_bytes = memory;
        options.budget.scratch_folder = folder();
        const auto volume = open_volume(options);
        ASSERT_TRUE(volume);
        const auto all = read(**volume, slab);
        ASSERT_TRUE(all) << all.error().message;
        const VoxelBox& box = (*volume)->info().box;
        const Dims dims = (*volume)->dims();
        for (std::int64_t i = 0; i < dims.count(); ++i)
          ASSERT_EQ((*all)[static_cast<std::size_t>(i)],
                    expected(box, i % dims.x, i / dims.x % dims.y, i / dims.slice()))
              << memory << " " << slab << " " << i;
      }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}), 1) << "scratch files have no names";
}

}  // namespace
}  // namespace dubsar
