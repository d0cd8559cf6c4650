#include "core/base/progress.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

TEST(Progress, NoEstimateBeforeFivePercentOrThreeSeconds) {
  EXPECT_LT(estimate_remaining_s(4, 100, 2.9), 0.0);
  EXPECT_DOUBLE_EQ(estimate_remaining_s(50, 100, 2.0), 2.0);
  EXPECT_DOUBLE_EQ(estimate_remaining_s(1, 100, 4.0), 396.0);
  EXPECT_DOUBLE_EQ(estimate_remaining_s(100, 100, 4.0), 0.0);
}

TEST(Progress, CancelIsSeenAndHasExitCode130) {
  SilentProgress progress;
  EXPECT_FALSE(progress.cancelled());
  progress.cancel();
  EXPECT_TRUE(progress.cancelled());
  EXPECT_EQ(exit_code(cancelled_error().value().kind), 130);
}

}  // namespace
}  // namespace dubsar
