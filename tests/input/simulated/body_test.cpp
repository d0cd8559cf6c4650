// The motor model of simulated people against what is known of people.

#include "tests/people/body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

Body calm() {
  Body body;
  body.tremor_m = body.sag_mps = 0.0;
  return body;
}

// Flash and Hogan (1985): the speed of a reaching hand is a bell whose peak is 1.875 times the mean.
TEST(Arm, AMovementIsSmoothAndItsPeakIsThatOfMinimumJerk) {
  Arm arm(calm(), false, 5);
  const double start = arm.hold(arm.raise(0.0, {0.1, 0.0, 0.4}), 0.2);
  const double end = arm.move(start, {-0.1, 0.0, 0.4});
  const double step = 1e-3;
  double fastest = 0.0, way = 0.0, largest_change = 0.0, before = 0.0;
  for (double t = start; t < end; t += step) {
    const double speed = glm::length(arm.at(t + step)->palm.position_m - arm.at(t)->palm.position_m) / step;
    way += speed * step;
    fastest = std::max(fastest, speed);
    largest_change = std::max(largest_change, std::abs(speed - before) / step);
    before = speed;
  }
  EXPECT_NEAR(fastest / (way / (end - start)), 1.875, 0.12);  // the bow adds a little
  EXPECT_LT(largest_change, 15.0);                            // m/s2: no jump of the speed anywhere
}

// Fitts (1954): twice as far or a target half as wide takes the same time longer.
TEST(Arm, TimesOfMovementsFollowFittsLaw) {
  const auto seconds = [](double way_m, double width_m) {
    Arm arm(calm(), false, 9);
    const double start = arm.raise(0.0, {0.0, 0.0, 0.4});
    return arm.move(start, {way_m, 0.0, 0.4}, width_m) - start;
  };
  const double one = seconds(0.1, 0.02), twice = seconds(0.2, 0.02), finer = seconds(0.1, 0.01);
  EXPECT_GT(twice, one);
  EXPECT_NEAR(twice, finer, 1e-9);
  EXPECT_NEAR(seconds(0.4, 0.02) - twice, twice - one, 1e-9);
}

TEST(Arm, HandsHangUnseenTiredOnesSinkAndTremorIsSmall) {
  Body body = calm();
  body.sag_mps = 0.005;
  body.tremor_m = 0.001;
  Arm arm(body, true, 3);
  EXPECT_FALSE(arm.at(0.0));
  const double up = arm.raise(1.0, {-0.1, 0.0, 0.4});
  EXPECT_NEAR(arm.at(up + 4.0)->palm.position_m.y, -0.02, 0.003);
  const double down = arm.lower(up + 5.0);
  EXPECT_TRUE(arm.at(down - 0.05));
  EXPECT_FALSE(arm.at(down + 0.01));
}

TEST(Body, PeopleAreOfAllSizesAndReachWhatTheyStandBefore) {
  ScriptRandom random(42);
  int children = 0, left = 0;
  for (int i = 0; i < 1000; ++i) {
    const Body body = draw_body(random);
    children += body.arm_m < 0.565 ? 1 : 0;
    left += body.left_handed ? 1 : 0;
    EXPECT_LE(glm::length(held_up_m(body, body.left_handed, 0.8) - shoulder_m(body, body.left_handed)),
              0.8 * body.arm_m + 1e-9);
  }
  EXPECT_NEAR(children, 250, 60);
  EXPECT_NEAR(left, 110, 40);
}

}  // namespace
}  // namespace dubsar
