#include "input/tracking/hands/hand_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/system/clock.h"
#include "devices/leap/hand_renderer.h"
#include "devices/leap/lmc1_simulator.h"
#include "tests/devices/leap/one_kind.h"
#include "tests/input/tracking/hands/hand_trials.h"

namespace dubsar {
namespace {

TEST(HandTracker, ADarkRoomWithoutHandsHasNone) {
  const auto calibration = example_calibration(true);
  const HandRenderer renderer(calibration, {});
  HandTracker tracker(stereo_lenses(calibration, 640, 240));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Hands hands(1);
    ASSERT_TRUE(tracker.track(render_frame(renderer, {}, seed), hands));
    EXPECT_TRUE(hands.empty());
  }
  Frame wrong;
  Hands hands;
  EXPECT_FALSE(tracker.track(wrong, hands));
}

TEST(HandTracker, TwoHandsAreFoundEachWithItsOwnSideAndGrab) {
  const auto calibration = example_calibration(true);
  const HandRenderer renderer(calibration, {});
  HandTracker tracker(stereo_lenses(calibration, 640, 240));
  HandPose left, right;
  left.left = true;
  left.palm.position_m = {-0.11, 0.28, 0.01};
  right.palm.position_m = {0.12, 0.33, -0.02};
  right.flexion.fill(0.97);
  const std::array<PosedHand, 2> posed{pose_hand(left), pose_hand(right)};
  Hands hands;
  for (std::uint64_t i = 1; i <= 3; ++i) {
    Frame frame = render_frame(renderer, posed, i);
    frame.time = static_cast<TimestampNs>(i) * 10'000'000;
    ASSERT_TRUE(tracker.track(frame, hands));
    ASSERT_EQ(hands.size(), 2U);
    for (const HandFrame& hand : hands) {
      const HandPose& truth = hand.palm.position_m.x < 0.0 ? left : right;
      EXPECT_EQ(hand.chirality == Chirality::kLeft, truth.left);
      EXPECT_EQ(hand.grab_strength > 0.5, truth.flexion[1] > 0.5);
      EXPECT_LT(std::hypot(hand.palm.position_m.x - truth.palm.position_m.x,
                           hand.palm.position_m.z - truth.palm.position_m.z),
                0.002);
      EXPECT_NEAR(hand.palm.position_m.y, truth.palm.position_m.y, 0.005);
    }
  }
}

TEST(HandTracker, ABrightThingThatIsNoHandIsNotTrusted) {
  const auto calibration = example_calibration(true);
  const HandRenderer renderer(calibration, {});
  HandTracker tracker(stereo_lenses(calibration, 640, 240));
  PosedHand ball;  // 120 mm across
  ball.cones.push_back({{0.0, 0.3, 0.0}, {0.0, 0.301, 0.0}, 0.06, 0.06});
  for (std::uint64_t i = 1; i <= 3; ++i) {
    Frame frame = render_frame(renderer, {&ball, 1}, i);
    frame.time = static_cast<TimestampNs>(i) * 10'000'000;
    Hands hands;
    ASSERT_TRUE(tracker.track(frame, hands));
    for (const HandFrame& hand : hands) EXPECT_LE(hand.confidence, 0.5);
  }
}

TEST(HandTracker, SimulatorDriverAndTrackerTogetherFollowOneHand) {
  Lmc1SimulatorOptions device;
  device.paced = true;
  device.hands = [](std::uint64_t) {
    HandPose pose;
    pose.palm.position_m = {0.03, 0.3, 0.02};
    return std::vector{pose_hand(pose)};
  };
  Lmc1Simulator simulator(device);
  SteadyClock clock;
  Lmc1Options options;
  options.calibration_settle = milliseconds(0);
  auto driver = lmc1_camera([&] { return simulator.open(); }, options, clock);
  ASSERT_TRUE(driver->start());
  HandTracker tracker(stereo_lenses(*driver->calibration(), options.width, options.height));
  Frame frame;
  Hands hands;
  std::uint32_t id = 0;
  int tracked = 0;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (tracked < 10 && std::chrono::steady_clock::now() < until) {
    // Not poll(): it reads all that has come, and a simulator that draws more slowly than its pace is never at an end.
    if (!driver->wait(frame, milliseconds(50))) continue;
    ASSERT_TRUE(tracker.track(frame, hands));
    ASSERT_EQ(hands.size(), 1U);
    if (id == 0) id = hands[0].id;
    EXPECT_EQ(hands[0].id, id);
    EXPECT_EQ(hands[0].chirality, Chirality::kRight);
    EXPECT_NEAR(hands[0].palm.position_m.x, 0.03, 0.001);
    EXPECT_NEAR(hands[0].palm.position_m.y, 0.30, 0.002);
    EXPECT_NEAR(hands[0].palm.position_m.z, 0.02, 0.001);
    ++tracked;
  }
  EXPECT_EQ(tracked, 10);
}

}  // namespace
}  // namespace dubsar
