// When the light of a picture reaches the eye.

#include "app/viewer/presenter/display_clock.h"

#include <gtest/gtest.h>

namespace dubsar::app {
namespace {

TEST(DisplayClock, LightIsTheMiddleOfTheScanAfterThePictureIsReady) {
  DisplayClock clock(100.0);  // 10 ms
  const TimestampNs ms = 1'000'000;
  EXPECT_EQ(clock.light(0), 15 * ms);
  clock.presented(100 * ms, 104 * ms, 110 * ms);     // takes 4 ms, the beat is at 110
  EXPECT_EQ(clock.light(111 * ms), (120 + 5) * ms);  // ready at 115
  EXPECT_EQ(clock.light(117 * ms), (130 + 5) * ms);  // ready at 121: misses one
  EXPECT_EQ(clock.light(1000 * ms), (1010 + 5) * ms);
  EXPECT_EQ(clock.next_start(), (110 - 4 + 10) * ms);
  DisplayClock unknown(0.0);
  EXPECT_EQ(unknown.period(), 16'666'666);
}

}  // namespace
}  // namespace dubsar::app
