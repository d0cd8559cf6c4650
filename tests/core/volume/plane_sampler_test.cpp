// Planes through volumes are trilinear samples of them, read brick by brick, never the whole file.

#include "core/volume/plane_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace dubsar {
namespace {

struct Asked {
  std::uint64_t bytes = 0, most_at_once = 0;
  bool empty = false;  ///< nobody looks at the values
};

float voxel(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto h = static_cast<std::uint32_t>(x * 73856093 ^ y * 19349663 ^ z * 83492791);
  return static_cast<float>(h % 2003) / 2003.0f;
}

/// A volume that is computed where it is asked for, and counts the bytes.
class CountingReader final : public VoxelReader {
 public:
  CountingReader(Dims dims, Dims chunk, Asked* asked) : dims_(dims), chunk_(chunk), asked_(asked) {}
  Dims dims() const noexcept override { return dims_; }
  Dims chunk() const noexcept override { return chunk_; }
  const NumberFormat& format() const noexcept override { return format_; }
  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    auto* to = reinterpret_cast<float*>(out.data());
    if (asked_->empty) std::fill_n(to, box.dims().count(), 0.5f);
    for (std::int64_t k = 0; !asked_->empty && k < box.z.count(); ++k)
      for (std::int64_t j = 0; j < box.y.count(); ++j)
        for (std::int64_t i = 0; i < box.x.count(); ++i) *to++ = voxel(box.x.at(i), box.y.at(j), box.z.at(k));
    const auto bytes = static_cast<std::uint64_t>(box.dims().count()) * sizeof(float);
    asked_->bytes += bytes;
    asked_->most_at_once = std::max(asked_->most_at_once, bytes);
    return {};
  }

 private:
  Dims dims_, chunk_;
  Asked* asked_;
  NumberFormat format_;
};

/// Straight from the definition.
double trilinear(const Dims& dims, const glm::dvec3& p) {
  const std::array<std::int64_t, 3> size{dims.x, dims.y, dims.z};
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::array<std::int64_t, 3> at{};
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      const double c = std::clamp(p[a], 0.0, static_cast<double>(size[i] - 1));
      const auto low = static_cast<std::int64_t>(std::floor(c));
      at[i] = std::min(low + (corner >> a & 1), size[i] - 1);
      weight *= (corner >> a & 1) != 0 ? c - static_cast<double>(low) : 1.0 - (c - static_cast<double>(low));
    }
    sum += weight * voxel(at[0], at[1], at[2]);
  }
  return sum;
}

bool inside(const Dims& dims, const glm::dvec3& p) {
  return p.x >= -0.5 && p.y >= -0.5 && p.z >= -0.5 && p.x <= static_cast<double>(dims.x) - 0.5 &&
         p.y <= static_cast<double>(dims.y) - 0.5 && p.z <= static_cast<double>(dims.z) - 0.5;
}

TEST(PlaneSampler, EveryPixelOfAnyPlaneIsTheTrilinearSampleOfTheVolume) {
  std::mt19937 random(std::random_device{}());
  const auto seed = random();
  random.seed(seed);
  SCOPED_TRACE(seed);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::uniform_int_distribution<std::int64_t> edge(1, 40), side(2, 90);
  for (int round = 0; round < 30; ++round) {
    const Dims dims{side(random), side(random), side(random)};
    const Dims chunk = round % 3 == 0 ? Dims{1, 1, 1} : Dims{edge(random), edge(random), edge(random)};
    Asked asked;
    PlaneSamplerOptions options;
    options.cache_bytes = round % 2 == 0 ? 1 : 1 << 20;  // one brick, or some
    const auto sampler = PlaneSampler::create(std::make_unique<CountingReader>(dims, chunk, &asked), options).value();
    PlaneGrid grid;
    grid.across_vox = {any(random), any(random), any(random)};
    grid.down_vox = {any(random), any(random), any(random)};
    if (round % 5 == 0) grid = {{0, 0, any(random) + 1}, {1, 0, 0}, {0, 1, 0}};
    grid.width = 57;
    grid.height = 41;
    if (round % 5 != 0)
      grid.first_vox = 0.5 * glm::dvec3(dims.x, dims.y, dims.z) - 28.0 * grid.across_vox - 20.0 * grid.down_vox;
    const PlaneImage image = sampler->sample(grid).value();
    ASSERT_TRUE(image.exact());
    for (int y = 0; y < grid.height; ++y)
      for (int x = 0; x < grid.width; ++x) {
        const glm::dvec3 p = grid.first_vox + double(x) * grid.across_vox + double(y) * grid.down_vox;
        const float found = image.values[static_cast<std::size_t>(y * grid.width + x)];
        if (!inside(dims, p)) {
          EXPECT_TRUE(std::isnan(found));
        } else {
          ASSERT_NEAR(found, trilinear(dims, p), 1e-6) << round << ": " << x << ", " << y;
        }
      }
  }
}

// 2.1 GB: 1024 x 1024 x 512 floats.
TEST(PlaneSampler, APlaneThroughALargeFileReadsASmallPartOfItInBoundedMemory) {
  const Dims dims{1024, 1024, 512};
  const std::uint64_t whole = static_cast<std::uint64_t>(dims.count()) * sizeof(float);
  ASSERT_GT(whole, 2'000'000'000u);
  const glm::dvec3 middle{511.5, 511.5, 255.5};
  const std::array<std::array<glm::dvec3, 2>, 4> planes{{{{{1, 0, 0}, {0, 1, 0}}},
                                                         {{{1, 0, 0}, {0, 0, 1}}},
                                                         {{{0, 1, 0}, {0, 0, 1}}},
                                                         {{{0.7, 0.7, 0}, {0, 0.3, 0.95}}}}};
  for (const Dims chunk : {Dims{64, 64, 64}, Dims{1, 1, 1}, Dims{1024, 1024, 1}}) {
    for (const auto& [across, down] : planes) {
      Asked asked;
      asked.empty = true;
      PlaneSamplerOptions options;
      options.cache_bytes = 64u << 20;
      const auto sampler = PlaneSampler::create(std::make_unique<CountingReader>(dims, chunk, &asked), options).value();
      PlaneGrid grid{middle - 128.0 * 4.0 * across - 64.0 * 4.0 * down, 4.0 * across, 4.0 * down, 256, 128};
      bool first = true;
      double first_known = 0.0;
      std::uint64_t first_bytes = 0;
      const PlaneImage image =
          sampler
              ->sample(grid,
                       [&](const PlanePicture& so_far) {
                         if (first && so_far.known() > 0.01) {
                           first = false;
                           first_known = so_far.known();
                           first_bytes = asked.bytes;
                           for (const float v : so_far.image(true).values) EXPECT_FALSE(std::isnan(v));
                           std::int64_t there = 0;
                           for (const float v : so_far.image().values) there += !std::isnan(v);
                           EXPECT_NEAR(static_cast<double>(there) / (256 * 128), so_far.known(), 1e-9);
                         }
                         EXPECT_LE(sampler->kept_bytes(), options.cache_bytes + (8u << 20));
                         return true;
                       })
              .value();
      EXPECT_LT(asked.bytes, whole / 4 + (8u << 20)) << chunk.x << " " << chunk.z;
      EXPECT_LT(asked.most_at_once, 8u << 20);
      EXPECT_LT(first_bytes, whole / 50) << "a coarse picture comes first";
      EXPECT_TRUE(first_known < 0.1 || first_bytes <= 8u << 20) << first_known;  // or all of it was quick
      EXPECT_TRUE(image.exact() || (chunk.z == 1 && chunk.x > 1));
    }
  }
}

TEST(PlaneSampler, APictureThatIsGivenUpIsCoarseAndTheNextOneKnowsWhatWasRead) {
  Asked asked;
  const Dims dims{256, 256, 64};
  const auto sampler = PlaneSampler::create(std::make_unique<CountingReader>(dims, Dims{32, 32, 32}, &asked)).value();
  const PlaneGrid grid{{0, 0, 10}, {1, 0, 0}, {0, 1, 0}, 256, 256};
  int bricks = 0;
  const PlaneImage coarse = sampler->sample(grid, [&](const PlanePicture&) { return ++bricks < 5; }).value();
  EXPECT_FALSE(coarse.exact());
  EXPECT_NEAR(coarse.known, 5.0 / 64, 0.01);
  const PlaneImage whole = sampler->sample(grid).value();
  EXPECT_TRUE(whole.exact());
  std::int64_t read = 0;
  for (std::size_t i = 0; i < coarse.values.size(); ++i) {
    if (std::isnan(coarse.values[i])) continue;  // nothing is made up of what was not read
    ++read;
    EXPECT_EQ(coarse.values[i], whole.values[i]);
  }
  EXPECT_NEAR(static_cast<double>(read), 5.0 / 64 * 256 * 256, 700);
  EXPECT_EQ(asked.bytes, 64u * 32 * 32 * 32 * 4) << "every brick once";
}

}  // namespace
}  // namespace dubsar
