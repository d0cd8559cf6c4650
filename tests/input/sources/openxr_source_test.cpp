// Hands and controllers of a headset's wearer as an input source.

#include "input/sources/openxr_source.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dubsar {
namespace {

using enum HandJoint;

/// A right hand, palm down, fingers ahead; `bend` degrees in each of a finger's two bends.
HandFrame hand_bent(double bend_deg) {
  HandFrame hand;
  const auto put = [&](HandJoint joint, const glm::dvec3& at) {
    hand.joint(joint) = {{at, {1, 0, 0, 0}}, 0.008, true, true};
  };
  put(kPalm, {0, 0, 0});
  put(kWrist, {0, 0, 0.07});
  const double bend = bend_deg * 3.14159265358979323846 / 180;
  const std::array<HandJoint, 4> metacarpals{kIndexMetacarpal, kMiddleMetacarpal, kRingMetacarpal, kLittleMetacarpal};
  for (std::size_t f = 0; f < 4; ++f) {
    const auto joint = [&](int i) { return static_cast<HandJoint>(static_cast<int>(metacarpals[f]) + i); };
    const double x = -0.02 + 0.02 * static_cast<double>(f);
    glm::dvec3 at(x, 0, -0.03);
    put(joint(0), {x, 0, 0.04});
    put(joint(1), at);
    const glm::dvec3 first(0, -std::sin(bend), -std::cos(bend)), second(0, -std::sin(2 * bend), -std::cos(2 * bend));
    put(joint(2), at + 0.02 * first);
    put(joint(3), at += 0.04 * first);
    put(joint(4), at + 0.02 * second);
  }
  put(kThumbTip, {-0.07, -0.03, -0.03});
  return hand;
}

TEST(WornHand, TheGrabIsHowFarTheFingersAreBent) {
  for (const auto& [bend, grab] : {std::pair{0.0, 0.0}, {15.0, 0.0}, {52.5, 0.5}, {90.0, 1.0}, {110.0, 1.0}}) {
    HandFrame hand = hand_bent(bend);
    complete_hand(hand);
    EXPECT_TRUE(hand.valid && hand.tracked);
    EXPECT_NEAR(hand.grab_strength, grab, 1e-6) << bend;
  }
}

TEST(WornHand, ThePinchIsTheDistanceOfTheTips) {
  HandFrame hand = hand_bent(0);
  hand.joint(kThumbTip).pose.position_m = hand.joint(kIndexTip).pose.position_m + glm::dvec3(0, -0.012, 0.005);
  complete_hand(hand);
  EXPECT_NEAR(hand.pinch_distance_m, 0.013, 1e-9);
  hand.joint(kIndexTip).valid = false;
  complete_hand(hand);
  EXPECT_FALSE(hand.valid);
}

struct Bench {
  std::shared_ptr<WornFeed> feed = std::make_shared<WornFeed>();
  std::unique_ptr<InputSource> source;
  InputFrame frame;
  TimestampNs now = 1'000'000'000;
  Bench() {
    InputConfig config;
    config.worn = feed;
    source = make_openxr_source(config).value();
  }
  Freshness after(const WornSample& sample) {
    WornSample timed = sample;
    timed.time = now += 10'000'000;
    feed->put(timed);
    return source->poll(now, frame);
  }
};

TEST(OpenXrSource, HandsKeepTheirNumberWhileTheyAreSeenAndHaveAVelocity) {
  Bench bench;
  EXPECT_EQ(bench.source->poll(bench.now, bench.frame), Freshness::kLost);
  EXPECT_NE(bench.source->note().find("no picture was made"), std::string::npos);
  WornSample sample;
  sample.hands[1] = hand_bent(0);
  EXPECT_EQ(bench.after(sample), Freshness::kNew);
  ASSERT_EQ(bench.frame.hands.size(), 1u);
  const auto id = bench.frame.hands[0].id;
  EXPECT_EQ(bench.frame.hands[0].chirality, Chirality::kRight);
  for (HandJointPose& joint : sample.hands[1]->joints) joint.pose.position_m.x += 0.002;
  bench.after(sample);
  EXPECT_EQ(bench.frame.hands[0].id, id);
  EXPECT_NEAR(bench.frame.hands[0].velocity_mps.x, 0.2, 1e-9);
  EXPECT_EQ(bench.source->poll(bench.now, bench.frame), Freshness::kUnchanged);
  bench.after({});
  EXPECT_TRUE(bench.frame.hands.empty());
  bench.after(sample);
  EXPECT_NE(bench.frame.hands[0].id, id) << "nobody knows whether it is the same";
  bench.feed->absent("openxr: the headset was lost");
  EXPECT_EQ(bench.source->poll(bench.now, bench.frame), Freshness::kLost);
  EXPECT_EQ(bench.source->note(), "openxr: the headset was lost");
  EXPECT_EQ(bench.after(sample), Freshness::kNew);
  EXPECT_EQ(bench.source->poll(bench.now + 600'000'000, bench.frame), Freshness::kLost) << "silent for too long";
}

TEST(OpenXrSource, ASqueezedControllerIsAClosedHandAndItsTriggerTheNextSide) {
  Bench bench;
  WornSample sample;
  sample.controllers[1] = {true, {{0.2, 0, 0.1}, {1, 0, 0, 0}}, 0.0, false};
  bench.after(sample);
  EXPECT_FALSE(bench.frame.space_mouse);
  EXPECT_FALSE(bench.frame.grips[0].active);
  ASSERT_TRUE(bench.frame.grips[1].active);
  EXPECT_TRUE(bench.frame.grips[1].controller);
  EXPECT_EQ(bench.frame.grips[1].pose.position_m, glm::dvec3(0.2, 0, 0.1));
  for (const auto& [squeeze, closed] : {std::pair{0.5, false}, {0.7, true}, {0.5, true}, {0.3, false}}) {
    sample.controllers[1].squeeze = squeeze;
    bench.after(sample);
    EXPECT_EQ(bench.frame.grips[1].closed, closed) << squeeze;
  }
  sample.controllers[1].select = true;
  bench.after(sample);
  ASSERT_EQ(bench.frame.events.size(), 1u);
  EXPECT_EQ(bench.frame.events[0].key, "puck1");
  EXPECT_TRUE(bench.frame.events[0].down);
}

/// Joints of one maker's headset let a pinch part for moments.
TEST(OpenXrSource, APinchThatBouncesIsOne) {
  for (const int parted_ms : {20, 40, 50}) {
    Bench bench;
    int opened = 0;
    for (int ms = 0; ms < 1000; ms += 10) {
      WornSample sample;
      sample.hands[1] = hand_bent(0);
      const bool bounce = ms % 200 >= 200 - parted_ms;
      const double apart = bounce ? 0.06 : 0.01;
      sample.hands[1]->joint(kThumbTip).pose.position_m =
          sample.hands[1]->joint(kIndexTip).pose.position_m + glm::dvec3(0, -apart, 0);
      bench.after(sample);
      opened += !bench.frame.grips[1].closed;
    }
    EXPECT_EQ(opened, 0) << parted_ms;
    for (int ms = 0; ms < 100; ms += 10) {
      WornSample sample;
      sample.hands[1] = hand_bent(0);
      bench.after(sample);
    }
    EXPECT_FALSE(bench.frame.grips[1].closed) << "and it is let go";
  }
}

TEST(OpenXrSource, NeedsAHeadsetAndTakesNoOptions) {
  EXPECT_EQ(make_openxr_source({}).error().kind, ErrorKind::kUnavailable);
  InputConfig config;
  config.worn = std::make_shared<WornFeed>();
  config.options = {{"left"}};
  EXPECT_EQ(make_openxr_source(config).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
