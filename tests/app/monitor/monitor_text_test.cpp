#include "app/monitor/monitor_text.h"

#include <gtest/gtest.h>

namespace dubsar::app {
namespace {
using nlohmann::json;

TEST(LiveView, BarsGoToTheSideOfTheirSignAndAreAsLongAsTheirShare) {
  const std::string view = monitor_text(
      {{"translation", {-0.5, 0.0, 2.0}}, {"rotation", {0.25, 0.0, 0.0}}, {"buttons", 5}, {"age_ms", 1.25}});
  EXPECT_NE(view.find("right   [          ##########|                    ]   -0.500"), std::string::npos) << view;
  EXPECT_NE(view.find("up      [                    |                    ]   +0.000"), std::string::npos) << view;
  EXPECT_NE(view.find("to you  [                    |####################]   +2.000"), std::string::npos) << view;
  EXPECT_NE(view.find("about x [                    |#####               ]"), std::string::npos) << view;
  EXPECT_NE(view.find("buttons 101\n"), std::string::npos);
  EXPECT_NE(view.find("age     1.25 ms\n"), std::string::npos);
}

TEST(LiveView, HeadsTurnsAreDegreesAndHandsHaveALineEach) {
  const double half = 0.25881904510252074;  // sine of 15 degrees
  const std::string head =
      monitor_text({{"position_m", {0.1, 0.0, 0.6}}, {"rotation_wxyz", {0.9659258262890683, 0.0, half, 0.0}}});
  EXPECT_NE(head.find("yaw     [                    |#######             ]  +30.000 deg"), std::string::npos) << head;
  EXPECT_NE(head.find("pitch   [                    |                    ]   +0.000 deg"), std::string::npos) << head;
  const json hand = {{"id", 3}, {"side", "right"}, {"palm_m", {0.012, 0.25, -0.03}}, {"grab", 0.42}, {"pinch_m", 0.05}};
  const std::string hands = monitor_text({{"hands", {hand, hand}}});
  const std::string line = "right   #3     x   +12  y  +250  z   -30 mm   grab [####      ]\n";
  EXPECT_EQ(hands, line + line);
  EXPECT_EQ(monitor_text({{"hands", json::array()}}), "no hand\n");
}

}  // namespace
}  // namespace dubsar::app
