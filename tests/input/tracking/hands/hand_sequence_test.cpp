// One hand that moves, turns, opens and closes, followed through a sequence of simulated pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "input/tracking/hands/hand_tracker.h"
#include "tests/input/tracking/hands/hand_trials.h"

namespace dubsar {
namespace {

/// A visitor: 60 mm to and fro in every direction at up to 0.4 m/s, turning by 20 degrees, closing the hand
/// every 1.5 s.
HandPose pose_at(double t) {
  const double turn = 360 * kDegree * t;
  HandPose pose;
  pose.palm.position_m = {0.06 * std::sin(0.9 * turn), 0.28 + 0.05 * std::sin(0.5 * turn + 1.0),
                          0.04 * std::sin(0.7 * turn)};
  pose.palm.rotation = glm::angleAxis(20 * kDegree * std::sin(0.4 * turn), glm::dvec3(0, 1, 0)) *
                       glm::angleAxis(8 * kDegree * std::sin(0.6 * turn), glm::dvec3(0, 0, 1));
  pose.flexion.fill(0.03 + 0.94 * std::clamp(0.5 - 0.9 * std::cos(turn / 1.5), 0.0, 1.0));
  pose.left = true;
  pose.scale = 1.08;
  return pose;
}

double quantile_of(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))];
}

TEST(HandSequence, AHandThatMovesTurnsAndClosesIsFollowedWithoutABreak) {
  const auto calibration = example_calibration(true);
  const HandRenderer renderer(calibration, {});
  HandTracker tracker(stereo_lenses(calibration, 640, 240));
  std::vector<double> sideways_mm, depth_mm, grab;
  for (int i = 0; i < 150; ++i) {
    const HandPose pose = pose_at(0.01 * i);
    const PosedHand hand = pose_hand(pose);
    Frame frame = render_frame(renderer, {&hand, 1}, static_cast<std::uint64_t>(i));
    frame.time = TimestampNs{10'000'000} * (i + 1);
    Hands hands;
    ASSERT_TRUE(tracker.track(frame, hands));
    ASSERT_EQ(hands.size(), 1U) << i;
    EXPECT_EQ(hands[0].id, 1U) << i;
    EXPECT_EQ(hands[0].chirality, Chirality::kLeft) << i;
    const glm::dvec3 error = 1e3 * (hands[0].palm.position_m - hand.palm_m);
    sideways_mm.push_back(std::max(std::abs(error.x), std::abs(error.z)));
    depth_mm.push_back(std::abs(error.y));
    grab.push_back(std::abs(hands[0].grab_strength - pose.flexion[2]));
  }
  EXPECT_LE(quantile_of(sideways_mm, 0.95), 2.0);
  EXPECT_LE(quantile_of(sideways_mm, 1.0), 5.0);
  EXPECT_LE(quantile_of(depth_mm, 0.95), 3.0);
  EXPECT_LE(quantile_of(grab, 0.95), 0.1);
  RecordProperty("sideways_95_mm", std::to_string(quantile_of(sideways_mm, 0.95)));
  RecordProperty("sideways_most_mm", std::to_string(quantile_of(sideways_mm, 1.0)));
  RecordProperty("depth_95_mm", std::to_string(quantile_of(depth_mm, 0.95)));
  RecordProperty("grab_95", std::to_string(quantile_of(grab, 0.95)));
}

TEST(HandSequence, ThumbAndIndexFingerThatComeTogetherAreSeen) {
  const auto calibration = example_calibration(true);
  const HandRenderer renderer(calibration, {});
  HandTracker tracker(stereo_lenses(calibration, 640, 240));
  std::vector<double> apart_mm, palm_mm;
  for (int i = 0; i < 80; ++i) {
    const double bend = 0.29 * (1.0 - std::cos(9 * kDegree * i));  // twice
    HandPose pose;
    pose.palm.position_m = {0.02, 0.28, 0.01};
    pose.flexion = {1.3 * bend, bend, 0.1, 0.1, 0.1};
    const PosedHand hand = pose_hand(pose);
    Frame frame = render_frame(renderer, {&hand, 1}, static_cast<std::uint64_t>(i));
    frame.time = TimestampNs{10'000'000} * (i + 1);
    Hands hands;
    ASSERT_TRUE(tracker.track(frame, hands));
    ASSERT_EQ(hands.size(), 1U) << i;
    EXPECT_LT(hands[0].grab_strength, 0.5) << i;
    apart_mm.push_back(1e3 * std::abs(glm::distance(hand.tips_m[0], hand.tips_m[1]) - hands[0].pinch_distance_m));
    palm_mm.push_back(1e3 * glm::distance(hands[0].palm.position_m, hand.palm_m));
  }
  EXPECT_LE(quantile_of(apart_mm, 0.5), 2.0);
  EXPECT_LE(quantile_of(apart_mm, 0.95), 8.0);
  EXPECT_LE(quantile_of(palm_mm, 0.95), 5.0);
  RecordProperty("apart_50_mm", std::to_string(quantile_of(apart_mm, 0.5)));
  RecordProperty("apart_95_mm", std::to_string(quantile_of(apart_mm, 0.95)));
  RecordProperty("palm_95_mm", std::to_string(quantile_of(palm_mm, 0.95)));
}

}  // namespace
}  // namespace dubsar
