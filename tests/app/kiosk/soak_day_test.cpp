// A day of a kiosk, with all that breaks in it.

#include "tests/app/kiosk/soak_day.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace dubsar::app::test {
namespace {

TEST(SoakDay, InTwelveHoursNobodyRestartsItAndEveryFaultIsOverWithinTwoSeconds) {
  constexpr double kHours = 12.0, kRateHz = 25.0, kBackS = 2.0;
  const SoakFigures day = simulate_day(kHours, kRateHz);
  EXPECT_GT(day.visits, 100);
  EXPECT_EQ(day.restarts, 0) << "that nobody asked for";
  EXPECT_LT(day.silence_s, 0.5 * kWatchdogS + kFaultS) << "as long as nothing is drawn it says nothing";
  EXPECT_EQ(day.never_back, 0);
  for (const std::string_view fault : kFaultNames) {
    const auto found = day.recovery_s.find(std::string(fault));
    ASSERT_NE(found, day.recovery_s.end()) << fault;
    EXPECT_GE(found->second.size(), 20U) << fault;
    EXPECT_LE(*std::max_element(found->second.begin(), found->second.end()), kBackS) << fault;
  }
}

}  // namespace
}  // namespace dubsar::app::test
