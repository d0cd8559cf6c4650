#include "core/phantom/phantom_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/system/parallel.h"
#include "core/filter/resample.h"
#include "core/phantom/write_phantom.h"
#include "tests/core/volume/read_all.h"

namespace dubsar::phantom {
namespace {

std::shared_ptr<const Phantom> make(Dims dims, std::uint64_t seed, double snr_db) {
  PhantomOptions options;
  options.dims = dims;
  options.seed = seed;
  options.snr_db = snr_db;
  return Phantom::create(options).value();
}

Volume<float> scan(const std::shared_ptr<const Phantom>& phantom, std::int64_t slab) {
  PhantomSource source(phantom);
  return dubsar::testing::read_all(source, slab).value();
}

TEST(PhantomScan, SameBytesForAnyThreadsAndSlabs) {
  const auto phantom = make({83, 50, 71}, 6, 17.0);
  set_thread_count(1);
  const Volume<float> expected = scan(phantom, 71);
  for (const auto& [threads, slab] : {std::pair{1, 5}, std::pair{2, 1}, std::pair{2, 40}, std::pair{7, 16}}) {
    set_thread_count(threads);
    const Volume<float> got = scan(phantom, slab);
    EXPECT_EQ(0, std::memcmp(expected.voxels.data(), got.voxels.data(),
                             static_cast<std::size_t>(got.dims.count()) * sizeof(float)))
        << threads << " threads, slabs of " << slab;
  }
  set_thread_count(0);
  PhantomSource source(phantom);  // backwards
  std::vector<float> slice(static_cast<std::size_t>(expected.dims.slice()));
  for (std::int64_t z = expected.dims.z - 1; z >= 0; z -= 7) {
    ASSERT_TRUE(source.read(z, z + 1, slice));
    EXPECT_EQ(0, std::memcmp(expected.row(0, z), slice.data(), slice.size() * sizeof(float)));
  }
}

struct Statistics {
  double clay_mean = 0, air_mean = 0, snr_db = 0;
};

// Mean and deviation of voxels some voxels of the scan away from any surface or grain, on every stride-th row.
Statistics measure(const Volume<float>& volume, const Phantom& phantom, const GridFrame& frame, std::int64_t stride) {
  double sum[2] = {0, 0}, squares[2] = {0, 0}, count[2] = {0, 0};
  for (std::int64_t z = 0; z < volume.dims.z; z += stride)
    for (std::int64_t y = 0; y < volume.dims.y; y += stride)
      for (std::int64_t x = 0; x < volume.dims.x; ++x) {
        const glm::dvec3 p =
            frame.input_vox_from_grid({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
        const Fields f = phantom.fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
        if (std::abs(f.clay.v) < 6.0f || f.grain.v < 6.0f) continue;
        const int i = f.clay.v < 0.0f ? 0 : 1;
        const auto value = static_cast<double>(volume.at(x, y, z));
        sum[i] += value;
        squares[i] += value * value;
        count[i] += 1.0;
      }
  const double clay = sum[0] / count[0], air = sum[1] / count[1];
  const double sigma = std::sqrt(squares[0] / count[0] - clay * clay);
  return {clay, air, 20.0 * std::log10((clay - air) / sigma)};
}

TEST(PhantomScan, IsAsNoisyAsAskedForWhateverItsBlur) {
  for (const double blur : {0.35, 0.8, 1.0}) {
    PhantomOptions options;
    options.dims = {192, 120, 180};
    options.seed = 5511;
    options.blur_vox = blur;
    const auto phantom = std::shared_ptr<const Phantom>(Phantom::create(options).value());
    PhantomSource source(phantom);
    const Volume<float> raw = dubsar::testing::read_all(source).value();
    EXPECT_NEAR(measure(raw, *phantom, source.frame(), 2).snr_db, 17.0, 0.3) << blur;
  }
}

TEST(PhantomScan, ClayAirAndNoiseAreThoseOfThePaper) {
  const auto phantom = make({192, 102, 177}, 1, 17.0);
  PhantomSource source(phantom);
  const Volume<float> raw = dubsar::testing::read_all(source).value();
  const Statistics before = measure(raw, *phantom, source.frame(), 2);
  EXPECT_NEAR(before.clay_mean, 0.0017, 0.0017 * 0.002);
  EXPECT_NEAR(before.air_mean, 0.0, 0.0017 * 0.002);
  EXPECT_NEAR(before.snr_db, 17.0, 0.3);
  HalfResolutionSource half(source);
  const Volume<float> resampled = dubsar::testing::read_all(half).value();
  EXPECT_NEAR(measure(resampled, *phantom, half.frame(), 1).snr_db, 23.0, 0.7);
}

TEST(PhantomScan, EdgeSpreadIsThatOfVoxelAndPsf) {
  // Without noise, voxels against signed distance: half the density at the surface, and the slope there of a blur with
  // variance 1/3 + 1/12: 0.0017 / (sqrt(2 pi) 0.645).
  const auto phantom = make({224, 119, 207}, 2, std::numeric_limits<double>::infinity());
  const Volume<float> volume = scan(phantom, 32);
  double n = 0, sd = 0, sv = 0, sdd = 0, sdv = 0;
  for (std::int64_t z = 0; z < volume.dims.z; z += 2)
    for (std::int64_t y = 0; y < volume.dims.y; y += 2)
      for (std::int64_t x = 0; x < volume.dims.x; ++x) {
        const Fields f = phantom->fields(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        // Only the smooth outside: wedges and relief have edges.
        if (std::abs(f.clay.v) > 0.5f || std::abs(f.outer.v) > 0.5f) continue;
        const double d =
            phantom->signed_distance({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
        if (std::abs(d) > 0.3) continue;
        const auto v = static_cast<double>(volume.at(x, y, z)) / 0.0017;
        n += 1, sd += d, sv += v, sdd += d * d, sdv += d * v;
      }
  ASSERT_GT(n, 1000);
  const double slope = (n * sdv - sd * sv) / (n * sdd - sd * sd), at_zero = (sv - slope * sd) / n;
  EXPECT_NEAR(at_zero, 0.5, 0.02);
  EXPECT_NEAR(slope, -0.62, 0.06);
}

TEST(PhantomScan, IsAsBlurredAsAskedForBeyondThreeTaps) {
  // The slope at the smooth outside of a blur of .9 voxel and a voxel's own extent: 1 / sqrt(2 pi (.81 + 1/12)).
  PhantomOptions options;
  options.dims = {224, 119, 207};
  options.seed = 2;
  options.snr_db = std::numeric_limits<double>::infinity();
  options.blur_vox = 0.9;
  const auto phantom = std::shared_ptr<const Phantom>(Phantom::create(options).value());
  const Volume<float> volume = scan(phantom, 32);
  double n = 0, sd = 0, sv = 0, sdd = 0, sdv = 0;
  for (std::int64_t z = 0; z < volume.dims.z; z += 2)
    for (std::int64_t y = 0; y < volume.dims.y; y += 2)
      for (std::int64_t x = 0; x < volume.dims.x; ++x) {
        const Fields f = phantom->fields(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        if (std::abs(f.clay.v) > 0.5f || std::abs(f.outer.v) > 0.5f) continue;
        const double d =
            phantom->signed_distance({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
        if (std::abs(d) > 0.3) continue;
        const auto v = static_cast<double>(volume.at(x, y, z)) / 0.0017;
        n += 1, sd += d, sv += v, sdd += d * d, sdv += d * v;
      }
  ASSERT_GT(n, 1000);
  EXPECT_NEAR((n * sdv - sd * sv) / (n * sdd - sd * sd), -1.0 / std::sqrt(2.0 * M_PI * (0.81 + 1.0 / 12.0)), 0.04);
}

/// Differences of two scans in parts of clay, by place.
struct Difference {
  Volume<float> of, without;
  double operator()(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<double>(of.at(x, y, z) - without.at(x, y, z)) / static_cast<double>(kClayDensity);
  }
};

template <class Change>
Difference difference(const Change& change) {
  PhantomOptions options;
  options.dims = {160, 96, 120};
  options.seed = 77;
  options.snr_db = std::numeric_limits<double>::infinity();
  const auto without = std::shared_ptr<const Phantom>(Phantom::create(options).value());
  change(options);
  const auto with = std::shared_ptr<const Phantom>(Phantom::create(options).value());
  return {scan(with, 50), scan(without, 50)};
}

TEST(PhantomScan, CuppingTakesClayFromTheMiddleAndNothingFromAir) {
  const Difference d = difference([](PhantomOptions& o) { o.artefacts.cupping = 0.15; });
  int clay = 0;
  for (std::int64_t z = 10; z < 110; z += 3) {
    const auto middle = static_cast<double>(d.without.at(79, 47, z));
    EXPECT_NEAR(d(79, 47, z), -0.15 * middle / static_cast<double>(kClayDensity), 1e-3);
    clay += middle > 0.9 * static_cast<double>(kClayDensity);
    EXPECT_EQ(d(1, 1, z), 0.0);
  }
  EXPECT_GT(clay, 10);
}

TEST(PhantomScan, StreaksHaveTheDeviationThatWasAskedFor) {
  const Difference d = difference([](PhantomOptions& o) { o.artefacts.streaks = 0.06; });
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (std::int64_t z = 0; z < 120; ++z)
    for (std::int64_t y = 0; y < 96; ++y)
      for (std::int64_t x = 0; x < 160; ++x) {
        const double v = d(x, y, z);
        sum += v, squares += v * v, n += 1.0;
      }
  EXPECT_NEAR(sum / n, 0.0, 0.005);
  EXPECT_NEAR(std::sqrt(squares / n), 0.06, 0.015);  // lines do not all cross the whole of a slice
}

TEST(PhantomScan, AHolderStandsAroundTheLowerEndOnly) {
  const Difference d = difference([](PhantomOptions& o) { o.artefacts.holder = 0.3; });
  double inside_air = 0.0, above = 0.0, inside_clay = 0.0;
  for (std::int64_t z = 0; z < 120; ++z)
    for (std::int64_t y = 0; y < 96; ++y)
      for (std::int64_t x = 0; x < 160; ++x) {
        const double v = d(x, y, z);
        if (z > 27) above = std::max(above, std::abs(v));
        if (static_cast<double>(d.without.at(x, y, z)) > 0.98 * static_cast<double>(kClayDensity))
          inside_clay = std::max(inside_clay, v);
        inside_air = std::max(inside_air, v);
      }
  EXPECT_NEAR(d(79, 85, 12), 0.3, 1e-4);
  EXPECT_NEAR(inside_air, 0.3, 1e-4);
  EXPECT_EQ(above, 0.0);
  EXPECT_LT(inside_clay, 0.02);
}

}  // namespace
}  // namespace dubsar::phantom
