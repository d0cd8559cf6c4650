// How deep pictures may be, against lines of sight.

#include "display/optics/comfort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "display/optics/off_axis.h"

namespace dubsar {
namespace {

constexpr double kDeg = 180.0 / std::numbers::pi;

/// Between the lines of sight of two eyes at (+-b/2, 0, d) to a point on the axis.
double angle_deg(double apart, double distance, double z) {
  const glm::dvec3 at(0.0, 0.0, z);
  const glm::dvec3 left = glm::normalize(at - glm::dvec3(-0.5 * apart, 0.0, distance));
  const glm::dvec3 right = glm::normalize(at - glm::dvec3(0.5 * apart, 0.0, distance));
  return kDeg * std::acos(glm::dot(left, right));
}

TEST(EasyDepth, IsWhereLinesOfSightDifferByOneDegree) {
  for (const EyesBefore eyes : {EyesBefore{600.0, 63.0}, {400.0, 63.0}, {1500.0, 52.0}}) {
    const EasyDepths range = easy_depth(eyes, 1.0);
    EXPECT_NEAR(parallax_deg(eyes, range.front_mm), 1.0, 1e-9);
    EXPECT_NEAR(
        angle_deg(eyes.apart_mm, eyes.distance_mm, range.front_mm) - angle_deg(eyes.apart_mm, eyes.distance_mm, 0.0),
        1.0, 1e-6);
    EXPECT_GT(range.front_mm, 0.0);
    ASSERT_LT(range.back_mm, 0.0);
    EXPECT_NEAR(parallax_deg(eyes, range.back_mm), -1.0, 1e-9);
  }
  // By hand: 63 mm at 600 mm are 6.0105 degrees; 7.0105 are at 514.24 mm, 5.0105 at 719.95 mm.
  EXPECT_NEAR(easy_depth({600.0, 63.0}, 1.0).front_mm, 85.8, 0.1);
  EXPECT_NEAR(easy_depth({600.0, 63.0}, 1.0).back_mm, -119.9, 0.1);
}

TEST(EasyDepth, FromFarAwayEyesThatAreParallelAreNotTooFar) {
  EXPECT_EQ(easy_depth({6000.0, 63.0}, 1.0).back_mm, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(easy_depth_factor({6000.0, 63.0}, 0.0, -1e6, 1.0), 1.0);
}

TEST(EasyDepth, FlattensWhatIsTooDeepAndNothingElse) {
  const EyesBefore eyes{600.0, 63.0};
  EXPECT_EQ(easy_depth_factor(eyes, 50.0, -50.0, 1.0), 1.0);
  const double factor = easy_depth_factor(eyes, 200.0, -200.0, 1.0);
  EXPECT_NEAR(parallax_deg(eyes, 200.0 * factor), 1.0, 1e-9);
  EXPECT_EQ(easy_depth_factor({600.0, 0.0}, 200.0, -200.0, 1.0), 1.0) << "one eye sees no parallax";
}

TEST(EasyDepth, EyesAreThoseOfTheCameras) {
  const WindowRect window = Screen().window_rect();
  std::vector<View> fan;
  for (const glm::dvec3& eye : cone_eyes(8, 0.7, 450.0)) fan.push_back(off_axis_view(window, eye, 10.0, 900.0));
  EXPECT_NEAR(eyes_before(fan, 63.0).distance_mm, 450.0, 1e-9);
  EXPECT_EQ(eyes_before(fan, 63.0).apart_mm, 63.0);
  const std::vector<View> two{off_axis_view(window, {-30.0, 20.0, 500.0}, 10.0, 900.0),
                              off_axis_view(window, {30.0, 20.0, 480.0}, 10.0, 900.0)};
  EXPECT_NEAR(eyes_before(two, 63.0).distance_mm, 480.0, 1e-9);
  EXPECT_NEAR(eyes_before(two, 63.0).apart_mm, std::hypot(60.0, 20.0), 1e-9);
  EXPECT_EQ(eyes_before(std::span(two).first(1), 63.0).apart_mm, 0.0);
}

}  // namespace
}  // namespace dubsar
