// The hand tracker over the other Leap camera: wider eyes, 64 mm apart.

#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "devices/leap/leap_camera.h"
#include "devices/leap/rigel_simulator.h"
#include "input/tracking/hands/hand_tracker.h"

namespace dubsar {
namespace {

TEST(RigelHands, SimulatorDriverAndTrackerFollowOneHand) {
  RigelSimulatorOptions device;
  device.stream.paced = true;
  device.stream.frame_limit = 3;
  const glm::dvec3 palm{0.03, 0.28, 0.02};
  device.hands = [&](std::uint64_t) {
    HandPose pose;
    pose.palm.position_m = palm;
    return std::vector{pose_hand(pose)};
  };
  RigelSimulator simulator(device);
  SteadyClock clock;
  LeapCameraOptions options;
  auto camera = make_leap_camera([&] { return simulator.open(); }, options, clock);
  const auto started = camera->start();
  ASSERT_TRUE(started) << started.error().message;
  HandTracker tracker(stereo_lenses(*camera->calibration(), camera->width(), camera->height()));
  Frame frame;
  Hands hands;
  std::uint32_t id = 0;
  int tracked = 0;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (frame.sequence < 3 && std::chrono::steady_clock::now() < until) {
    // Not poll(): it reads all that has come, and a simulator that draws more slowly than its pace is never at an end.
    if (!camera->wait(frame, milliseconds(50))) continue;
    ASSERT_TRUE(tracker.track(frame, hands));
    ASSERT_EQ(hands.size(), 1U);
    if (id == 0) id = hands[0].id;
    EXPECT_EQ(hands[0].id, id);
    EXPECT_EQ(hands[0].chirality, Chirality::kRight);
    EXPECT_LT(hands[0].grab_strength, 0.3);
    EXPECT_NEAR(hands[0].palm.position_m.x, palm.x, 0.002);
    EXPECT_NEAR(hands[0].palm.position_m.y, palm.y, 0.003);
    EXPECT_NEAR(hands[0].palm.position_m.z, palm.z, 0.002);
    ++tracked;
  }
  EXPECT_GE(tracked, 1);
}

TEST(RigelHands, OpenHandsAndFistsAt200To400MmAreWhereTheyAre) {
  const auto calibration = example_rigel_calibration();
  HandRenderOptions options;
  options.height = 480;
  const HandRenderer renderer(calibration, options);
  HandTracker tracker(stereo_lenses(calibration, options.width, options.height));
  Frame frame;
  frame.width = options.width;
  frame.height = options.height;
  frame.views = 2;
  frame.pixels.resize(2 * frame.view_bytes());
  const std::span<std::uint8_t> pixels(frame.pixels);
  for (const double height_m : {0.2, 0.3, 0.4})
    for (const bool fist : {false, true}) {
      HandPose pose;
      pose.palm.position_m = {-0.02, height_m, 0.01};
      if (fist) pose.flexion.fill(1.0);
      const PosedHand posed = pose_hand(pose);
      renderer.render({&posed, 1}, ++frame.sequence, pixels.first(frame.view_bytes()), pixels.last(frame.view_bytes()));
      frame.time += 1'000'000'000;
      Hands hands;
      ASSERT_TRUE(tracker.track(frame, hands));
      ASSERT_EQ(hands.size(), 1U) << height_m << fist;
      const glm::dvec3 off_mm = 1e3 * (hands[0].palm.position_m - pose.palm.position_m);
      RecordProperty(fmt::format("off_mm_{}_{}", 1e3 * height_m, fist ? "fist" : "open"),
                     fmt::format("{:.1f} {:.1f} {:.1f}", off_mm.x, off_mm.y, off_mm.z));
      EXPECT_NEAR(off_mm.x, 0.0, 2.0) << height_m << fist;
      EXPECT_NEAR(off_mm.y, 0.0, 5.0) << height_m << fist;
      EXPECT_NEAR(off_mm.z, 0.0, 2.0) << height_m << fist;
      EXPECT_EQ(hands[0].grab_strength > 0.75, fist) << height_m;
    }
}

}  // namespace
}  // namespace dubsar
