#include "core/rays/straighten.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rays/curve_search.h"
#include "tests/core/rays/simulated_scan.h"

namespace dubsar {
namespace {

constexpr Dims kBentDims{104, 72, 36};
constexpr double kScatter = 0.08, kBentAbsorbed = 0.045;

struct Scene {
  Volume<float> straight, bent;
};

const Scene& scene() {
  static const Scene both = [] {
    test::Scanner scanner;
    const auto object = test::tablet_in_envelope(1.0);
    Scene made;
    made.straight = test::scan(object, kBentDims, scanner);
    scanner.recorded = test::scattering(kScatter, kBentAbsorbed);
    made.bent = test::scan(object, kBentDims, scanner);
    return made;
  }();
  return both;
}

Volume<float> copy_of(const Volume<float>& from) {
  Volume<float> copy(from.dims);
  std::copy(from.voxels.data(), from.voxels.data() + from.dims.count(), copy.voxels.data());
  return copy;
}

/// Root mean square of what is left of b after the best a * scale + offset, in parts of the contrast of b.
double difference(const Volume<float>& a, const Volume<float>& b) {
  double n = 0, sa = 0, sb = 0, saa = 0, sab = 0, sbb = 0;
  for (std::int64_t i = 0; i < a.dims.count(); ++i) {
    const double x = a.voxels[i], y = b.voxels[i];
    n += 1, sa += x, sb += y, saa += x * x, sab += x * y, sbb += y * y;
  }
  const double cab = sab - sa * sb / n, caa = saa - sa * sa / n, cbb = sbb - sb * sb / n;
  return std::sqrt((cbb - cab * cab / caa) / n);
}

StraightenOptions options_for(const Volume<float>& volume) {
  SilentProgress progress;
  const CurveSearch search = *search_curve(volume, 3, {}, {}, progress);
  EXPECT_TRUE(search.found);
  return {search.found->axis, search.levels, search.found->curve, search.found->stray};
}

TEST(Straighten, GivesBackWhatScatterTook) {
  GridStore grid(copy_of(scene().bent));
  SilentProgress progress;
  ASSERT_TRUE(straighten(grid, options_for(scene().bent), progress));
  const Volume<float> done = grid.take_volume();
  const double before = difference(scene().bent, scene().straight), after = difference(done, scene().straight);
  EXPECT_GT(before, 0.05);
  EXPECT_LT(after, 0.25 * before) << before;
}

// The long faces of the tablet are seen by the longest rays: their edge, across the gap, in the middle of the object.
TEST(Straighten, EdgesOnLongRaysGetTheirContrastBack) {
  GridStore grid(copy_of(scene().bent));
  SilentProgress progress;
  ASSERT_TRUE(straighten(grid, options_for(scene().bent), progress));
  const Volume<float> done = grid.take_volume();
  const auto edge = [](const Volume<float>& v) {
    const std::int64_t z = kBentDims.z / 2, x = kBentDims.x / 2;
    float gap = 1e9F, clay = 0.0F;
    for (std::int64_t y = 46; y < 54; ++y) gap = std::min(gap, v.at(x, y, z));
    for (std::int64_t y = 40; y < 46; ++y) clay += v.at(x, y, z) / 6.0F;
    return (clay - gap) / clay;
  };
  EXPECT_LT(edge(scene().bent), 0.8 * edge(scene().straight));
  EXPECT_NEAR(edge(done), edge(scene().straight), 0.05 * edge(scene().straight));
}

// A curve of lengths alone cannot: behind the middle of the object there is more scatter than at its rim.
TEST(Straighten, GivesBackWhatScatterTookThatVariesOverTheDetector) {
  test::Scanner scanner;
  scanner.absorbed = kBentAbsorbed;
  scanner.stray = 0.15;
  const Volume<float> bent = test::scan(test::tablet_in_envelope(1.0), kBentDims, scanner);
  StraightenOptions options = options_for(bent);
  ASSERT_TRUE(options.stray);
  EXPECT_NEAR(options.stray->spread(), scanner.spread, 0.4 * scanner.spread);
  GridStore grid(copy_of(bent));
  SilentProgress progress;
  ASSERT_TRUE(straighten(grid, options, progress));
  const Volume<float> done = grid.take_volume();
  const double before = difference(bent, scene().straight), after = difference(done, scene().straight);
  EXPECT_GT(before, 0.05);
  EXPECT_LT(after, 0.35 * before) << before;
}

TEST(Straighten, AnAxisThatWasOffIsFoundAboutTheRightAxisOnly) {
  test::Scanner scanner;
  scanner.axis_off = 0.5;
  GridStore off(test::scan(test::tablet_in_envelope(1.0), kBentDims, scanner));
  const auto shift_about = [](GridStore& grid, TurnAxis axis) {
    return find_shift_in(grid, {axis, {0.0, 1.0}, {{1.0}, 100.0}})->pixels;
  };
  EXPECT_NEAR(std::abs(shift_about(off, TurnAxis::kZ)), 0.5, 0.1);
  EXPECT_EQ(shift_about(off, TurnAxis::kX), 0.0);
  EXPECT_EQ(shift_about(off, TurnAxis::kY), 0.0);
  GridStore right(copy_of(scene().straight));
  EXPECT_EQ(shift_about(right, TurnAxis::kZ), 0.0);
}

TEST(Straighten, AStraightCurveChangesNoBit) {
  GridStore grid(copy_of(scene().straight));
  SilentProgress progress;
  ASSERT_TRUE(straighten(grid, {TurnAxis::kZ, {0.0, 1.0}, {{1.0}, 100.0}}, progress));
  const Volume<float> done = grid.take_volume();
  for (std::int64_t i = 0; i < kBentDims.count(); ++i) ASSERT_EQ(done.voxels[i], scene().straight.voxels[i]);
}

TEST(Straighten, MemoryAndDiskGiveTheSameBits) {
  const StraightenOptions options = options_for(scene().bent);
  SilentProgress progress;
  GridStore memory(copy_of(scene().bent));
  GridStore disk = *GridStore::create(kBentDims, {}, GridPlace::kScratch, {});
  for (std::int64_t z = 0; z < kBentDims.z; ++z) {
    const std::span<float> page = disk.page(z, z + 1);
    std::copy(scene().bent.row(0, z), scene().bent.row(0, z) + kBentDims.slice(), page.begin());
    ASSERT_TRUE(disk.store(z, z + 1));
  }
  ASSERT_TRUE(straighten(memory, options, progress));
  ASSERT_TRUE(straighten(disk, options, progress));
  Volume<float> a(kBentDims), b(kBentDims);
  ASSERT_TRUE(memory.read(0, kBentDims.z, a.voxels.span()));
  ASSERT_TRUE(disk.read(0, kBentDims.z, b.voxels.span()));
  for (std::int64_t i = 0; i < kBentDims.count(); ++i) ASSERT_EQ(a.voxels[i], b.voxels[i]);
  const auto refused = straighten(disk, {TurnAxis::kX, options.levels, options.curve}, progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kTryAgain);
}

TEST(Straighten, StopsWhenCancelled) {
  GridStore grid(copy_of(scene().bent));
  SilentProgress progress;
  progress.cancel();
  const auto stopped = straighten(grid, {TurnAxis::kZ, {0.0, 1.0}, {{1.0, 1.0}, 100.0}}, progress);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
