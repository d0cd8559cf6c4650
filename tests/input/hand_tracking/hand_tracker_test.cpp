#include "input/hand_tracking/hand_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include "core/base/clock.h"
#include "devices/leap/hand_renderer.h"
#include "devices/leap/lmc1_driver.h"
#include "devices/leap/lmc1_simulator.h"

namespace dubsar {
namespace {

constexpr double kDegree = 3.14159265358979 / 180.0;

struct Trial {
  HandPose pose;
  bool fist = false;
};

/// A hand anywhere in the zone, palm down, 0.9 to 1.1 of the usual size, turned by up to 25 and tilted by up to 8 degrees.
Trial random_trial(std::mt19937& random, double height_m) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  Trial trial;
  trial.fist = random() % 2 == 0;
  HandPose& pose = trial.pose;
  pose.palm.position_m = {uniform(-0.25, 0.25) * height_m, height_m, uniform(-0.25, 0.25) * height_m};
  pose.palm.rotation = glm::angleAxis(uniform(-25, 25) * kDegree, glm::dvec3(0, 1, 0)) *
                       glm::angleAxis(uniform(-8, 8) * kDegree, glm::dvec3(1, 0, 0)) *
                       glm::angleAxis(uniform(-8, 8) * kDegree, glm::dvec3(0, 0, 1));
  for (double& flexion : pose.flexion) flexion = trial.fist ? uniform(0.9, 1.0) : uniform(0.0, 0.12);
  pose.spread = uniform(0.6, 1.0);
  pose.scale = uniform(0.9, 1.1);
  pose.left = random() % 2 == 0;
  return trial;
}

Frame render(const HandRenderer& renderer, std::span<const PosedHand> hands, std::uint64_t seed) {
  Frame frame;
  frame.width = renderer.options().width;
  frame.height = renderer.options().height;
  frame.views = 2;
  frame.pixels.resize(2 * frame.view_bytes());
  const std::span pixels(frame.pixels);
  renderer.render(hands, seed, pixels.first(frame.view_bytes()), pixels.last(frame.view_bytes()));
  return frame;
}

struct Errors {
  std::vector<double> x, along, depth, yaw;  // mm, degrees
  int trials = 0, seen = 0, grab_right = 0, chirality_right = 0, chirality_said = 0, open = 0, five_tips = 0;
  std::vector<double> tips, cpu_ms;
  double signed_along = 0, signed_depth = 0, r = 0;
};

double percentile(std::vector<double> values, double p) {
  if (values.empty()) return 1e9;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))];
}

void run(const HandRenderer& renderer, HandTracker& tracker, double height_m, int trials, std::mt19937& random, Errors& e,
         int only_fist = -1) {
  for (int i = 0; i < trials; ++i) {
    const Trial trial = random_trial(random, height_m);
    if (only_fist >= 0 && trial.fist != (only_fist == 1)) continue;
    const PosedHand hand = pose_hand(trial.pose);
    Frame frame = render(renderer, {&hand, 1}, random());
    frame.time = i;
    Hands hands;
    tracker.reset();
    const double before = process_cpu_seconds();
    ASSERT_TRUE(tracker.track(frame, hands));
    e.cpu_ms.push_back(1e3 * (process_cpu_seconds() - before));
    ++e.trials;
    if (hands.size() != 1) continue;
    ++e.seen;
    const HandFrame& found = hands[0];
    const glm::dvec3 error = 1e3 * (found.palm.position_m - hand.palm_m);
    e.x.push_back(std::abs(error.x));
    e.along.push_back(std::abs(error.z));
    e.depth.push_back(std::abs(error.y));
    e.signed_along += error.z;
    e.signed_depth += error.y;
    e.grab_right += (found.grab_strength > 0.5) == trial.fist ? 1 : 0;
    const glm::dvec3 to_fingers = found.palm.rotation * glm::dvec3(0, 0, -1);
    const glm::dvec3 truth = trial.pose.palm.rotation * glm::dvec3(0, 0, -1);
    e.yaw.push_back(std::abs(std::atan2(to_fingers.x, -to_fingers.z) - std::atan2(truth.x, -truth.z)) / kDegree);
    if (found.chirality != Chirality::kUnknown) {
      ++e.chirality_said;
      e.chirality_right += (found.chirality == Chirality::kLeft) == trial.pose.left ? 1 : 0;
    }
    if (!trial.fist) {
      ++e.open;
      constexpr std::array<HandJoint, 5> kTips{HandJoint::kThumbTip, HandJoint::kIndexTip, HandJoint::kMiddleTip,
                                               HandJoint::kRingTip, HandJoint::kLittleTip};
      int tracked = 0;
      for (std::size_t f = 0; f < 5; ++f)
        if (found.joint(kTips[f]).tracked) {
          ++tracked;
          e.tips.push_back(1e3 * glm::distance(found.joint(kTips[f]).pose.position_m, hand.tips_m[f]));
        }
      e.five_tips += tracked == 5 ? 1 : 0;
    }
  }
}

void print(const char* what, double height_m, const Errors& e) {
  std::printf("%s at %.0f mm: %d seen of %d, grab right %d; median and p95 of x %.2f %.2f, along %.2f %.2f, depth %.2f %.2f mm; chirality right %d of %d; CPU p50 %.2f p99 %.2f ms\n",
              what, 1e3 * height_m, e.seen, e.trials, e.grab_right, percentile(e.x, 0.5), percentile(e.x, 0.95),
              percentile(e.along, 0.5), percentile(e.along, 0.95), percentile(e.depth, 0.5), percentile(e.depth, 0.95),
              e.chirality_right, e.chirality_said, percentile(e.cpu_ms, 0.5), percentile(e.cpu_ms, 0.99));
}

TEST(HandTracker, OpenHandsAndFistsAreToldApartAndThePalmIsFound) {
  const auto calibration = example_calibration(true);
  const HandRenderer renderer(calibration, {});
  HandTracker tracker(stereo_lenses(calibration, 640, 240));
  int seen = 0, trials = 0, right = 0;
  for (const int fist : {0, 1})
    for (const double height : {0.2, 0.25, 0.3, 0.35, 0.4}) {
      std::mt19937 random(2026);  // not the poses that the constants were tuned on
      Errors e;
      run(renderer, tracker, height, 70, random, e, fist);
      print(fist == 1 ? "fist" : "open", height, e);
      seen += e.seen;
      trials += e.trials;
      right += e.grab_right;
      // What it does today, with a margin. The aim is 2 mm sideways and 5 mm in depth for every frame: docs/leap.md.
      EXPECT_LE(percentile(e.x, 0.5), fist == 1 ? 8.0 : 2.5);
      EXPECT_LE(percentile(e.along, 0.5), 6.0);
      EXPECT_LE(percentile(e.depth, 0.5), fist == 1 ? 8.0 : 2.5);
      if (fist == 0) {
        EXPECT_LE(percentile(e.depth, 0.95), 6.0);
        EXPECT_GE(e.chirality_right, 0.98 * e.chirality_said);
      }
    }
  EXPECT_EQ(seen, trials);
  EXPECT_GE(right, 0.99 * trials);
}

TEST(HandTracker, ADarkRoomWithoutHandsHasNone) {
  const auto calibration = example_calibration(true);
  const HandRenderer renderer(calibration, {});
  HandTracker tracker(stereo_lenses(calibration, 640, 240));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Hands hands(1);
    ASSERT_TRUE(tracker.track(render(renderer, {}, seed), hands));
    EXPECT_TRUE(hands.empty());
  }
  Frame wrong;
  Hands hands;
  EXPECT_FALSE(tracker.track(wrong, hands));
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
  auto driver = make_lmc1_driver([&] { return simulator.open(); }, options, clock);
  ASSERT_TRUE(driver->start());
  HandTracker tracker(stereo_lenses(*driver->calibration(), options.width, options.height));
  Frame frame;
  Hands hands;
  std::uint32_t id = 0;
  int tracked = 0;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(15);
  while (tracked < 10 && std::chrono::steady_clock::now() < until) {
    if (!driver->poll(frame)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_TRUE(tracker.track(frame, hands));
    ASSERT_EQ(hands.size(), 1U);
    if (id == 0) id = hands[0].id;
    EXPECT_EQ(hands[0].id, id);
    EXPECT_EQ(hands[0].chirality, Chirality::kRight);
    EXPECT_NEAR(hands[0].palm.position_m.x, 0.03, 0.004);
    EXPECT_NEAR(hands[0].palm.position_m.y, 0.30, 0.006);
    EXPECT_NEAR(hands[0].palm.position_m.z, 0.02, 0.008);
    ++tracked;
  }
  EXPECT_EQ(tracked, 10);
}

}  // namespace
}  // namespace dubsar
