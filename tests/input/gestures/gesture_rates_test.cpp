// The same movements seen by slow and by fast trackers: webcams and depth cameras give 25 or 30 hands a second, a Leap
// 110.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "input/navigation/navigation.h"
#include "tests/input/gestures/gesture_person.h"

namespace dubsar::test {
namespace {

constexpr std::array<double, 6> kRatesHz{25, 30, 60, 90, 110, 120};

/// A hand that is sampled so many times a second.
struct Sampled {
  Person person;
  double hz, t_s = 0.0;
  std::mt19937 random{20261127};
  double noise_m = 0.0;

  Sampled(double rate_hz, const GestureOptions& options) : person(options), hz(rate_hz) {}
  void step(const glm::dvec3& at_m) {
    std::normal_distribution<double> noise(0.0, 1.0);
    t_s += 1.0 / hz;
    HandFrame& hand = person.hand;
    hand.palm.position_m = at_m + noise_m * glm::dvec3(noise(random), noise(random), noise(random));
    hand.time = person.now = static_cast<TimestampNs>(1e9 * t_s);
    person.recognizer.update(person.now, &hand, person.standing);
    const auto& events = person.recognizer.events();
    person.events.insert(person.events.end(), events.begin(), events.end());
  }
  void rest(const glm::dvec3& at_m, double seconds) {
    for (const double end = t_s + seconds; t_s < end - 0.5 / hz;) step(at_m);
  }
  /// From rest to rest: at 3 (t/T)^2 - 2 (t/T)^3 of the way.
  void go(const glm::dvec3& from_m, const glm::dvec3& to_m, double seconds) {
    const double begun = t_s;
    while (t_s < begun + seconds - 0.5 / hz) {
      const double u = std::min(1.0, (t_s + 1.0 / hz - begun) / seconds);
      step(from_m + u * u * (3.0 - 2.0 * u) * (to_m - from_m));
    }
  }
  void close_to(double strength, double seconds, const glm::dvec3& at_m) {
    const double from = person.hand.grab_strength, begun = t_s;
    while (t_s < begun + seconds - 0.5 / hz) {
      const double u = std::min(1.0, (t_s + 1.0 / hz - begun) / seconds);
      person.hand.grab_strength = from + u * (strength - from);
      step(at_m);
    }
  }
};

GestureOptions desk() { return default_mapping().value().gestures; }

class AtEveryRate : public ::testing::TestWithParam<double> {};

TEST_P(AtEveryRate, SpeedIsThatOfTheHandWithinATenthWhateverTheNoise) {
  for (const double noise_m : {0.0, 0.0004, 0.001}) {
    Sampled hand(GetParam(), desk());
    hand.noise_m = noise_m;
    hand.rest({-0.3, 0.0, 0.3}, 0.5);
    double square = 0.0;
    int count = 0;
    for (double x = -0.3; x < 0.3; x += 0.5 / hand.hz) {
      hand.step({x, 0.0, 0.3});
      if (x < -0.2) continue;  // 200 ms on its way
      square += std::pow(hand.person.recognizer.velocity_mps().x - 0.5, 2);
      ++count;
    }
    EXPECT_LT(std::sqrt(square / count), 0.001 + 0.1 * 0.5 * noise_m / 0.001)
        << "m/s, with noise of " << noise_m << " m";
  }
}

TEST_P(AtEveryRate, AWipeOf200MillimetresIn400MillisecondsSwipesOnceToItsSide) {
  struct Case {
    glm::dvec3 way_m;
    SwipeDirection side;
  };
  for (const auto& options : {desk(), gallery()})
    for (const Case& one : {Case{{0.2, 0, 0}, SwipeDirection::kRight}, Case{{-0.2, 0, 0}, SwipeDirection::kLeft},
                            Case{{0, 0.2, 0}, SwipeDirection::kUp}, Case{{0, -0.2, 0}, SwipeDirection::kDown}}) {
      Sampled hand(GetParam(), options);
      hand.noise_m = 0.0004;
      const glm::dvec3 from = glm::dvec3(0.0, 0.0, 0.3) - 0.5 * one.way_m, to = from + one.way_m;
      hand.rest(from, 4.0);
      hand.go(from, to, 0.4);
      hand.rest(to, 0.6);
      ASSERT_EQ(hand.person.count(GestureKind::kSwipe, GesturePhase::kDone), 1)
          << (options.swipe.still_ns > 0 ? "gallery" : "desk") << ", way " << one.way_m.x << " " << one.way_m.y;
      for (const GestureEvent& event : hand.person.events)
        if (event.kind == GestureKind::kSwipe) {
          EXPECT_EQ(event.direction, one.side);
        }
    }
}

TEST_P(AtEveryRate, ATremblingHandADriftingHandAndASlowWayDoNotSwipe) {
  for (const auto& options : {desk(), gallery()}) {
    Sampled trembles(GetParam(), options), slow(GetParam(), options);
    for (int i = 0; i < static_cast<int>(8 * GetParam()); ++i)
      trembles.step({0.012 * std::sin(2.0 * 3.14159265 * 4.0 * i / GetParam()), 0.0, 0.3});  // 300 mm/s at most
    EXPECT_EQ(trembles.person.count(GestureKind::kSwipe, GesturePhase::kDone), 0);
    slow.rest({-0.1, 0, 0.3}, 4.0);
    slow.go({-0.1, 0, 0.3}, {0.1, 0, 0.3}, 1.0);  // 300 mm/s at most
    slow.rest({0.1, 0, 0.3}, 0.6);
    EXPECT_EQ(slow.person.count(GestureKind::kSwipe, GesturePhase::kDone), 0);
  }
}

TEST_P(AtEveryRate, AHandAtRestThatClosesTakesHoldAndLetsGoAsItOpens) {
  for (const auto& options : {desk(), gallery()}) {
    const glm::dvec3 at(0.05, 0.0, 0.3);
    Sampled hand(GetParam(), options);
    hand.noise_m = 0.0004;
    hand.rest(at, 1.5);
    hand.close_to(1.0, 0.25, at);
    hand.rest(at, 0.5);
    EXPECT_TRUE(hand.person.recognizer.grabbing());
    hand.close_to(0.0, 0.25, at);
    hand.rest(at, 0.3);
    EXPECT_EQ(hand.person.count(GestureKind::kGrab, GesturePhase::kBegin), 1);
    EXPECT_EQ(hand.person.count(GestureKind::kGrab, GesturePhase::kEnd), 1);
    EXPECT_EQ(hand.person.count(GestureKind::kGrab, GesturePhase::kCancel), 0);
  }
}

TEST_P(AtEveryRate, AHandThatClosesOnItsWayTakesNoHoldInAGallery) {
  Sampled hand(GetParam(), gallery());
  hand.rest({-0.2, 0, 0.3}, 1.5);
  for (double x = -0.2; x < 0.1; x += 0.5 / hand.hz) {
    hand.person.hand.grab_strength = x < -0.15 ? 0.0 : 1.0;
    hand.step({x, 0.0, 0.3});
  }
  hand.rest({0.1, 0, 0.3}, 1.0);
  EXPECT_EQ(hand.person.count(GestureKind::kGrab, GesturePhase::kBegin), 0);
}

TEST_P(AtEveryRate, ThumbAndIndexFingerPinchAndARestingHandDwells) {
  for (const auto& options : {desk(), gallery()}) {
    const glm::dvec3 at(0.05, 0.0, 0.3);
    Sampled hand(GetParam(), options);
    hand.rest(at, 1.0);
    hand.person.hand.pinch_distance_m = 0.015;
    hand.rest(at, 0.5);
    EXPECT_TRUE(hand.person.recognizer.pinching());
    hand.person.hand.pinch_distance_m = 0.06;
    hand.rest(at, 0.5);
    EXPECT_EQ(hand.person.count(GestureKind::kPinch, GesturePhase::kEnd), 1);
    hand.go(at, at + glm::dvec3(0.1, 0, 0), 0.6);
    hand.rest(at + glm::dvec3(0.1, 0, 0), 2.0);
    EXPECT_GE(hand.person.count(GestureKind::kDwell, GesturePhase::kDone), 1);
  }
}

/// How far the object goes on, degrees, after a fist that carried it at 400 mm/s has opened on its way.
double thrown_deg(double hz) {
  Mapping mapping = default_mapping().value();
  Navigator navigator(mapping);
  HandFrame hand;
  hand.id = 1;
  hand.valid = hand.tracked = true;
  hand.pinch_distance_m = 0.06;
  double t_s = 0.0, opened_s = -1.0;
  glm::dquat let_go{1, 0, 0, 0};
  glm::dvec3 at(-0.15, 0.0, 0.3);
  while (t_s < 6.0) {
    t_s += 1.0 / hz;
    if (t_s > 1.0) hand.grab_strength = 1.0;
    if (t_s > 1.5 && t_s < 2.2) at.x += 0.4 / hz;
    if (t_s > 2.0) hand.grab_strength = 0.0;
    hand.palm.position_m = at;
    const auto now = static_cast<TimestampNs>(1e9 * t_s);
    hand.time = now;
    InputFrame frame;
    frame.time = now;
    navigator.update(now, frame, {&hand, nullptr}, {HandStanding{.sure = true}, HandStanding{}});
    if (opened_s < 0.0 && t_s > 2.0) {
      opened_s = t_s;
      let_go = navigator.view().rotation;
    }
  }
  return turn_between_deg(let_go, navigator.view().rotation);
}

TEST_P(AtEveryRate, AThrownObjectGoesOnAsFar) {
  const double at_120 = thrown_deg(120.0);
  ASSERT_GT(at_120, 20.0) << "else nothing was thrown";
  EXPECT_NEAR(thrown_deg(GetParam()), at_120, 0.15 * at_120);
}

std::string in_hz(const ::testing::TestParamInfo<double>& info) {
  return "Hz" + std::to_string(static_cast<int>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Hands, AtEveryRate, ::testing::ValuesIn(kRatesHz), in_hz);

TEST(SlowTrackers, OneSampleOfThreeLostIsStillASpeed) {
  PositionHistory history(60 * kMs);
  for (int i = 0; i < 30; ++i)
    if (i % 3 != 1) history.add({i * 33 * kMs, {0.5 * 0.033 * i, 0.0, 0.3}});
  EXPECT_NEAR(history.velocity_mps().x, 0.5, 1e-9);
}

TEST(SlowTrackers, AGapOfAFastTrackerIsNoSlowTracker) {
  PositionHistory history(60 * kMs);
  for (int i = 0; i < 20; ++i) history.add({i * 10 * kMs, {0.0, 0.0, 0.3}});
  history.add({400 * kMs, {0.2, 0.0, 0.3}});  // 210 ms later and elsewhere
  EXPECT_EQ(history.velocity_mps(), glm::dvec3(0.0)) << "nothing is known of its speed yet";
}

}  // namespace
}  // namespace dubsar::test
