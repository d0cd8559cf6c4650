#include "display/panels/crosstalk_curve.h"

#include <gtest/gtest.h>

#include "display/panels/panel_set.h"

namespace dubsar {
namespace {

PanelProfile laptop_profile() { return built_in_panels().find("spatiallabs-15.6").value(); }

TEST(CrosstalkCurve, OfTheLaptopPanelStaysWithinItsBounds) {
  CrosstalkQuestion question;
  question.head_mm_s = {0, 100, 200, 400};
  question.latency_ms = {20, 40, 75};
  question.places_mm = {{120, 60, 500}};
  const auto curve = crosstalk_curve(laptop_profile(), question);
  ASSERT_TRUE(curve) << curve.error().message;
  EXPECT_LE(curve->nominal, 0.04);
  EXPECT_LE(curve->worst_sideways, 0.05);
  EXPECT_GE(curve->worst_sideways, curve->nominal);
  ASSERT_EQ(curve->lags.size(), 12u);
  for (const CrosstalkCurve::Lag& lag : curve->lags) {
    EXPECT_DOUBLE_EQ(lag.moved_mm, lag.head_mm_s * lag.latency_ms / 1000);
    for (const CrosstalkCurve::Lag& other : curve->lags) {
      if (other.moved_mm > lag.moved_mm) {
        EXPECT_GT(other.wrong, lag.wrong) << other.moved_mm << " and " << lag.moved_mm << " mm";
      }
    }
    if (lag.moved_mm == 0) {
      EXPECT_EQ(lag.wrong, curve->nominal);
    }
    if (lag.moved_mm == 8) {
      EXPECT_NEAR(lag.wrong, 0.065, 0.006);
    }
    if (lag.moved_mm == 15) {
      EXPECT_NEAR(lag.wrong, 0.13, 0.011);
    }
    if (lag.moved_mm == 30) {
      EXPECT_NEAR(lag.wrong, 0.47, 0.03) << "half a period is 31.5 mm";
    }
  }
  ASSERT_EQ(curve->places.size(), 1u);
  EXPECT_NEAR(curve->places[0].exact, 0.045, 0.006);
  EXPECT_NEAR(curve->places[0].paraxial, 0.126, 0.008);
}

TEST(CrosstalkCurve, IsForTrackedPanels) {
  const auto sheet = built_in_panels().find("lens-sheet-24-5-views").value();
  EXPECT_EQ(crosstalk_curve(sheet).error().kind, ErrorKind::kConfig);
}

}  // namespace
}  // namespace dubsar
