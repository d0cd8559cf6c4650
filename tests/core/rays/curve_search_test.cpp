#include "core/rays/curve_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/core/rays/simulated_scan.h"

namespace dubsar {
namespace {

constexpr Dims kSearchedDims{104, 72, 48};
constexpr double kAbsorbed = 0.045;  // 3.9 along the longest way

test::Scanner scanner_with(double scatter) {
  test::Scanner scanner;
  if (scatter > 0.0) scanner.recorded = test::scattering(scatter, kAbsorbed);
  scanner.noise = 0.05;
  return scanner;
}

CurveSearch search(const Volume<float>& volume) {
  SilentProgress progress;
  return *search_curve(volume, 3, {}, {}, progress);
}

TEST(CurveSearch, FindsTheCurveOfScatterWithoutGeometry) {
  for (const double scatter : {0.03, 0.08}) {
    const CurveSearch found = search(test::scan(test::tablet_in_envelope(1.0), kSearchedDims, scanner_with(scatter)));
    ASSERT_TRUE(found.found) << scatter;
    EXPECT_EQ(found.found->axis, TurnAxis::kZ);
    const RayCurve& curve = found.found->curve;
    for (const double part : {0.5, 0.9}) {
      const double p = part * curve.longest;
      const double straight = test::straight_length(p * found.levels.contrast(), scatter, kAbsorbed);
      EXPECT_NEAR(curve.value(p), straight, 0.05 * straight) << scatter << " at " << part;
    }
  }
}

TEST(CurveSearch, LeavesStraightRaysAlone) {
  const CurveSearch found = search(test::scan(test::tablet_in_envelope(1.0), kSearchedDims, scanner_with(0.0)));
  EXPECT_FALSE(found.found) << found.found->bend();
  EXPECT_EQ(found.trials.size(), 3u);
}

/// A box of clay that lies aslant, its edges some two voxels wide, and noise that neighbours share, as in a halved
/// scan.
Volume<float> noisy_box(unsigned seed, float noise) {
  Volume<float> out(Dims{52, 40, 46});
  const Dims d = out.dims;
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<float> values(static_cast<std::size_t>(d.count())), spread(values);
  for (float& v : values) v = noise * normal(random);
  const std::size_t count = values.size();
  for (const std::size_t step : {std::size_t{1}, std::size_t(d.x), std::size_t(d.slice())}) {
    for (std::size_t i = 0; i < count; ++i) spread[i] = 0.5F * (values[i] + values[(i + step) % count]);
    values = spread;
  }
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) {
        const double dx = double(x) - 25.6, dy = double(y) - 19.8, dz = double(z) - 22.6;
        const double px = 0.96 * dx - 0.28 * dy, py = 0.8 * (0.28 * dx + 0.96 * dy) - 0.6 * dz,
                     pz = 0.6 * (0.28 * dx + 0.96 * dy) + 0.8 * dz;
        const double off = std::max({std::abs(px) - 17.0, std::abs(py) - 10.0, std::abs(pz) - 11.0});
        out.at(x, y, z) =
            static_cast<float>(0.5 * std::erfc(off)) + values[static_cast<std::size_t>((z * d.y + y) * d.x + x)];
      }
  return out;
}

// So few pixels of clay and air are uneven by their noise alone, and any curve evens some of it.
TEST(CurveSearch, NoiseOfASmallBodyBendsNoRays) {
  int by_chance = 0;  // that would be taken for bent if they were judged by the planes that they were fitted in
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const CurveSearch found = search(noisy_box(seed, seed % 2 != 0 ? 0.25F : 0.35F));
    EXPECT_EQ(found.trials.size(), 3U);
    EXPECT_FALSE(found.found) << "seed " << seed << ": bent by " << found.found->bend();
    for (const CurveTrial& trial : found.trials) {
      EXPECT_FALSE(trial.significant()) << "seed " << seed;
      by_chance += trial.bend() > 1.1 && trial.left() < 0.8 ? 1 : 0;
    }
  }
  EXPECT_GT(by_chance, 5);
}

// What a curve takes away is measured with its error, and noise makes that larger, not the gain.
TEST(CurveSearch, ACurveIsJudgedInPlanesThatItWasNotFittedIn) {
  const CurveSearch found = search(test::scan(test::tablet_in_envelope(1.0), kSearchedDims, scanner_with(0.08)));
  ASSERT_TRUE(found.found);
  const Elsewhere& elsewhere = found.found->elsewhere;
  EXPECT_TRUE(elsewhere.sure());
  EXPECT_NEAR(elsewhere.left, found.found->left(), 0.1);
  EXPECT_NEAR(elsewhere.gain, found.found->before.sum() - found.found->after.sum(), 3.0 * elsewhere.error);
}

TEST(CurveSearch, FindsTheAxisOfAScanThatLiesOnItsSide) {
  const Volume<float> upright = test::scan(test::tablet_in_envelope(1.0), kSearchedDims, scanner_with(0.08));
  for (const TurnAxis axis : {TurnAxis::kX, TurnAxis::kY}) {
    const bool x = axis == TurnAxis::kX;
    Volume<float> lying(x ? Dims{kSearchedDims.z, kSearchedDims.x, kSearchedDims.y}
                          : Dims{kSearchedDims.y, kSearchedDims.z, kSearchedDims.x});
    for (std::int64_t k = 0; k < kSearchedDims.z; ++k)
      for (std::int64_t j = 0; j < kSearchedDims.y; ++j)
        for (std::int64_t i = 0; i < kSearchedDims.x; ++i)
          (x ? lying.at(k, i, j) : lying.at(j, k, i)) = upright.at(i, j, k);
    const CurveSearch found = search(lying);
    ASSERT_TRUE(found.found);
    EXPECT_EQ(found.found->axis, axis);
  }
}

TEST(CurveSearch, GreysMayHaveAnyUnitAndZero) {
  Volume<float> volume = test::scan(test::tablet_in_envelope(1.0), kSearchedDims, scanner_with(0.08));
  const CurveSearch plain = search(volume);
  for (float& value : volume.voxels.span()) value = 250.0F * value - 1000.0F;
  const CurveSearch scaled = search(volume);
  ASSERT_TRUE(plain.found && scaled.found);
  EXPECT_NEAR(scaled.found->bend(), plain.found->bend(), 0.01 * plain.found->bend());
}

}  // namespace
}  // namespace dubsar
