// Real hands before a Leap Motion: 1105 frames of leapd's protocol 6 at 81 to 116 Hz, recorded by Leap Motion for its
// library leapjs-playback (Apache-2.0). They are read where they lie and are no part of the project.
//
// What they show of hands: palms, speeds and strengths as that tracker of 2014 gave them. They hold no times, so a
// frame counts as 1 / currentFrameRate; no head, no reaching in, no visitor: nothing is said by them of how well
// galleries are understood.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "input/navigation/mapping.h"
#include "tests/input/gestures/gesture_person.h"

namespace dubsar::test {
namespace {
using nlohmann::json;

/// Above the sensor, which lies 200 mm below the middle of the screen and 300 mm before it.
constexpr glm::dvec3 kScreenFromLeapM{0.0, -0.2, 0.3};

glm::dvec3 metres(const json& mm) { return 1e-3 * glm::dvec3(mm.at(0), mm.at(1), mm.at(2)); }

struct Recorded {
  std::vector<std::vector<HandFrame>> frames;
  double median_hz = 0.0;
};

Recorded read(const std::string& name) {
  std::ifstream in(std::filesystem::path(DUBSAR_REAL_DATA) / ("leap_" + name + ".json"));
  Recorded out;
  if (!in) return out;
  std::vector<double> rates;
  double t_s = 1.0;
  const json all = json::parse(in);
  for (const json& frame : all.at("frames")) {
    rates.push_back(frame.at("currentFrameRate"));
    t_s += 1.0 / rates.back();
    std::vector<HandFrame>& hands = out.frames.emplace_back();
    for (const json& hand : frame.at("hands")) {
      HandFrame& h = hands.emplace_back();
      h.time = static_cast<TimestampNs>(1e9 * t_s);
      h.id = hand.at("id");
      h.chirality = hand.at("type") == "left" ? Chirality::kLeft : Chirality::kRight;
      h.valid = h.tracked = true;
      h.confidence = hand.at("confidence");
      h.palm.position_m = metres(hand.at("palmPosition")) + kScreenFromLeapM;
      h.velocity_mps = metres(hand.at("palmVelocity"));
      h.grab_strength = hand.at("grabStrength");
      h.pinch_distance_m = 0.1;
      for (const json& finger : frame.at("pointables")) {
        if (finger.at("handId") != hand.at("id")) continue;
        constexpr std::array<HandJoint, 5> kTips{HandJoint::kThumbTip, HandJoint::kIndexTip, HandJoint::kMiddleTip,
                                                 HandJoint::kRingTip, HandJoint::kLittleTip};
        const auto place = [&](HandJoint which, const char* what) {
          h.joint(which) = {{metres(finger.at(what)) + kScreenFromLeapM, {1, 0, 0, 0}}, 0.01, true, true};
        };
        const int type = finger.at("type");
        place(kTips.at(static_cast<std::size_t>(type)), "tipPosition");
        if (type == 1) place(HandJoint::kIndexProximal, "mcpPosition");
        if (type == 2) place(HandJoint::kMiddleProximal, "mcpPosition");
      }
      h.pinch_distance_m =
          glm::distance(h.joint(HandJoint::kThumbTip).pose.position_m, h.joint(HandJoint::kIndexTip).pose.position_m);
    }
  }
  std::nth_element(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2), rates.end());
  out.median_hz = rates[rates.size() / 2];
  return out;
}

/// What one hand of a recording did, of which each `every`-th frame was seen. It was there, open and at rest, for 4 s
/// before.
std::vector<GestureEvent> events_of(const Recorded& recorded, Chirality side, std::size_t every,
                                    const GestureOptions& options) {
  GestureRecognizer recognizer(options);
  std::vector<GestureEvent> out;
  const auto see = [&](const HandFrame& hand) {
    recognizer.update(hand.time, &hand, {.sure = true});
    out.insert(out.end(), recognizer.events().begin(), recognizer.events().end());
  };
  bool before = false;
  for (std::size_t i = 0; i < recorded.frames.size(); i += every)
    for (HandFrame hand : recorded.frames[i]) {
      if (hand.chirality != side) continue;
      constexpr TimestampNs kBeforeNs = 4'000'000'000, kStepNs = 9'000'000;
      const TimestampNs at = hand.time + kBeforeNs;
      if (!before) {
        HandFrame resting = hand;
        resting.grab_strength = 0.0;
        for (TimestampNs t = hand.time; t < at; t += kStepNs * static_cast<TimestampNs>(every)) {
          resting.time = t;
          see(resting);
        }
      }
      before = true;
      hand.time = at;
      see(hand);
    }
  return out;
}

int count(const std::vector<GestureEvent>& events, GestureKind kind, GesturePhase phase) {
  return static_cast<int>(std::count_if(events.begin(), events.end(),
                                        [&](const GestureEvent& e) { return e.kind == kind && e.phase == phase; }));
}

class RealHands : public ::testing::Test {
 protected:
  void SetUp() override {
    grab_ = read("grab");
    claps_ = read("three-claps");
    flapping_ = read("flapping");
    if (grab_.frames.empty() || claps_.frames.empty() || flapping_.frames.empty())
      GTEST_SKIP() << "no recordings of real hands in " << DUBSAR_REAL_DATA;
  }
  Recorded grab_, claps_, flapping_;
  static constexpr std::array<std::size_t, 4> kEvery{1, 2, 3, 4};  // some 115, 57, 38, 29 Hz
};

/// That tracker smoothed its speeds: they are .6 to .8 of what its palms moved, one to two frames later, so that they
/// cannot be met, but followed.
TEST_F(RealHands, SpeedGoesWithWhatTheTrackerSaidOfItWhateverTheRate) {
  for (const Recorded* recorded : {&grab_, &claps_, &flapping_})
    for (const std::size_t every : kEvery) {
      std::array<PositionHistory, 2> histories{PositionHistory(60 * kMs), PositionHistory(60 * kMs)};
      double ours = 0.0, theirs = 0.0, both = 0.0;
      for (std::size_t i = 0; i < recorded->frames.size(); i += every)
        for (const HandFrame& hand : recorded->frames[i]) {
          PositionHistory& history = histories[hand.chirality == Chirality::kLeft ? 1 : 0];
          history.add({hand.time, hand.palm.position_m});
          const glm::dvec3 speed = history.velocity_mps();
          ours += glm::dot(speed, speed);
          theirs += glm::dot(hand.velocity_mps, hand.velocity_mps);
          both += glm::dot(speed, hand.velocity_mps);
        }
      EXPECT_GT(both / std::sqrt(ours * theirs), 0.8) << recorded->median_hz / static_cast<double>(every) << " Hz";
    }
}

/// Its palm goes by 18 to 45 mm as the fingers close, at up to .24 m/s.
TEST_F(RealHands, TheHandThatClosesTwiceGrabsTwiceWhateverTheRate) {
  for (const auto& options : {default_mapping().value().gestures, gallery_mapping().value().gestures})
    for (const std::size_t every : kEvery) {
      const auto events = events_of(grab_, Chirality::kRight, every, options);
      EXPECT_EQ(count(events, GestureKind::kGrab, GesturePhase::kBegin), 2) << "each " << every;
      EXPECT_EQ(count(events, GestureKind::kGrab, GesturePhase::kEnd), 2) << "each " << every;
      EXPECT_EQ(count(events, GestureKind::kSwipe, GesturePhase::kDone), 0) << "each " << every;
    }
}

TEST_F(RealHands, WhoClapsOrFlapsDoesNotSwipe) {
  for (const auto& options : {default_mapping().value().gestures, gallery_mapping().value().gestures})
    for (const std::size_t every : kEvery)
      for (const Chirality side : {Chirality::kLeft, Chirality::kRight}) {
        const auto claps = events_of(claps_, side, every, options), flaps = events_of(flapping_, side, every, options);
        EXPECT_EQ(count(claps, GestureKind::kSwipe, GesturePhase::kDone), 0) << "each " << every;
        EXPECT_EQ(count(flaps, GestureKind::kSwipe, GesturePhase::kDone), 0) << "each " << every;
        EXPECT_EQ(count(claps, GestureKind::kGrab, GesturePhase::kBegin), 0) << "each " << every;
      }
}

}  // namespace
}  // namespace dubsar::test
