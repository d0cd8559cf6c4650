// Figures of a head tracker before a tracked panel.

#include "app/calibration/eye_check.h"

#include <gtest/gtest.h>

#include "display/panels/panel_set.h"

namespace dubsar::app {
namespace {

EyeCheck laptop(double delay_ms) {
  const PanelProfile panel = built_in_panels().find("spatiallabs-15.6").value();
  EyeCheckOptions options;
  options.delay_ms = delay_ms;
  return EyeCheck(panel_optics(panel, panel.zone.design_distance_mm).value(), options);
}

EyePair eyes_at(double x) { return {{x - 31.5, 0, 600}, {x + 31.5, 0, 600}}; }

/// 100 heads a second for 0.5 s, at 200 mm/s.
EyeCheck moved(double delay_ms, double mm_s) {
  EyeCheck check = laptop(delay_ms);
  for (int i = 0; i < 50; ++i) check.add(1'000'000'000 + i * 10'000'000, eyes_at(mm_s * 0.01 * (i - 49)));
  return check;
}

TEST(EyeCheck, AHeadAtRestGetsTheLensesOwnLightOnly) {
  const EyeCheck check = moved(40, 0);
  EXPECT_DOUBLE_EQ(check.wrong_light().value(), check.own_light().value());
  EXPECT_LE(check.own_light().value(), 0.04);
  EXPECT_EQ(check.a_second(), 50);
}

/// Eight millimetres of lag let 6.5 % through (the figures of an independent simulation, docs/displays.md).
TEST(EyeCheck, ADelayCostsWhatTheOpticsSay) {
  EXPECT_NEAR(100 * moved(40, 200).wrong_light().value(), 6.5, 0.6);
  EXPECT_NEAR(100 * moved(80, 200).wrong_light().value(), 15.3, 0.8);
  EXPECT_LE(moved(0, 200).wrong_light().value(), 0.04);
}

TEST(EyeCheck, NothingIsSaidBeforeEnoughIsKnown) {
  EyeCheck check = laptop(100);
  EXPECT_FALSE(check.wrong_light());
  check.add(0, eyes_at(0));
  check.add(50'000'000, eyes_at(1));
  EXPECT_FALSE(check.wrong_light());
  check.add(110'000'000, eyes_at(2));
  EXPECT_TRUE(check.wrong_light());
}

}  // namespace
}  // namespace dubsar::app
