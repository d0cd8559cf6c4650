#include "core/rays/curve_search.h"

#include <gtest/gtest.h>

#include "tests/core/rays/simulated_scan.h"

namespace dubsar {
namespace {

constexpr Dims kDims{104, 72, 48};
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
    const CurveSearch found = search(test::scan(test::tablet_in_envelope(1.0), kDims, scanner_with(scatter)));
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
  const CurveSearch found = search(test::scan(test::tablet_in_envelope(1.0), kDims, scanner_with(0.0)));
  EXPECT_FALSE(found.found) << found.found->bend();
  EXPECT_EQ(found.trials.size(), 3u);
}

TEST(CurveSearch, FindsTheAxisOfAScanThatLiesOnItsSide) {
  const Volume<float> upright = test::scan(test::tablet_in_envelope(1.0), kDims, scanner_with(0.08));
  for (const TurnAxis axis : {TurnAxis::kX, TurnAxis::kY}) {
    const bool x = axis == TurnAxis::kX;
    Volume<float> lying(x ? Dims{kDims.z, kDims.x, kDims.y} : Dims{kDims.y, kDims.z, kDims.x});
    for (std::int64_t k = 0; k < kDims.z; ++k)
      for (std::int64_t j = 0; j < kDims.y; ++j)
        for (std::int64_t i = 0; i < kDims.x; ++i) (x ? lying.at(k, i, j) : lying.at(j, k, i)) = upright.at(i, j, k);
    const CurveSearch found = search(lying);
    ASSERT_TRUE(found.found);
    EXPECT_EQ(found.found->axis, axis);
  }
}

TEST(CurveSearch, GreysMayHaveAnyUnitAndZero) {
  Volume<float> volume = test::scan(test::tablet_in_envelope(1.0), kDims, scanner_with(0.08));
  const CurveSearch plain = search(volume);
  for (float& value : volume.voxels.span()) value = 250.0F * value - 1000.0F;
  const CurveSearch scaled = search(volume);
  ASSERT_TRUE(plain.found && scaled.found);
  EXPECT_NEAR(scaled.found->bend(), plain.found->bend(), 0.01 * plain.found->bend());
}

}  // namespace
}  // namespace dubsar
