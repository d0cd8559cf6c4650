// Fingers as a pointer and what the navigator makes of it, against the similarities of the plane.

#include "input/gestures/touch_pointer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "input/navigation/navigation.h"
#include "tests/input/milliseconds.h"

namespace dubsar {
namespace {

using Complex = std::complex<double>;
using test::kMs;

/// A window over a touch panel, 100 reports a second; what fingers make goes to a navigator.
struct Glass {
  Mapping mapping = default_mapping().value();
  Navigator navigator{mapping};
  TouchPointer pointer;
  std::map<std::uint32_t, glm::dvec2> fingers;
  std::vector<InputEvent> events;  // all there were
  TimestampNs now = 1'000'000'000;
  std::optional<double> lever;
  std::optional<glm::dvec3> eye;

  void report(bool cancelled = false, TimestampNs later = 10 * kMs) {
    now += later;
    std::vector<PlacedTouch> placed;
    for (const auto& [id, at] : fingers) placed.push_back({id, at, std::abs(at.x) <= 0.8 && std::abs(at.y) <= 0.5});
    std::vector<InputEvent> made;
    pointer.update(now, placed, cancelled, made);
    pass(std::move(made));
  }
  void rest(TimestampNs time) {
    now += time;
    std::vector<InputEvent> made;
    pointer.advance(now, made);
    pass(std::move(made));
  }
  void pass(std::vector<InputEvent> made) {
    InputFrame frame;
    frame.time = now;
    for (InputEvent& event : made) {
      if (event.kind == EventKind::kPinch || event.down) {
        event.lever = lever;
        event.eye = eye;
      }
      events.push_back(event);
    }
    frame.events = std::move(made);
    navigator.update(now, frame, {});
  }
  int count(EventKind kind, bool down) const {
    int out = 0;
    for (const InputEvent& event : events) out += event.kind == kind && event.down == down;
    return out;
  }
  const ViewState& view() const { return navigator.view(); }
};

Complex of(const glm::dvec2& v) { return {v.x, v.y}; }
glm::dvec2 of(const Complex& c) { return {c.real(), c.imag()}; }

/// Where the view shows a place of the object, seen from far away.
glm::dvec2 seen(const ViewState& view, const glm::dvec3& place) {
  return view.pan + view.zoom * glm::dvec2(view.rotation * place);
}

TEST(TouchPointer, TwoPointsThatMoveByASimilarityGiveExactlyItsScaleRollAndWay) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 1000; ++i) {
    const std::size_t count = 2 + random() % 4;
    const double factor = std::exp(real(-2, 2)), roll = real(-3.1, 3.1);
    const Complex turn = std::polar(factor, roll), shift(real(-1, 1), real(-1, 1));
    std::vector<glm::dvec2> before, after;
    glm::dvec2 middle{0.0};
    for (std::size_t k = 0; k < count; ++k) {
      before.emplace_back(real(-0.5, 0.5), real(-0.5, 0.5));
      after.push_back(of(turn * of(before.back()) + shift));
      middle += before.back() / static_cast<double>(count);
    }
    if (glm::distance(before[0], before[1]) < 0.1) continue;
    const PinchStep step = pinch_between(before, after);
    EXPECT_NEAR(step.factor, factor, 1e-9 * factor) << "seed " << seed;
    EXPECT_NEAR(step.roll_rad, roll, 1e-9) << "seed " << seed;
    EXPECT_NEAR(glm::distance(step.by, of(turn * of(middle) + shift) - middle), 0.0, 1e-9) << "seed " << seed;
  }
  const std::vector<glm::dvec2> together{{0.1, 0.1}, {0.1, 0.1}}, apart{{0.0, 0.1}, {0.4, 0.1}};
  EXPECT_EQ(pinch_between(together, apart).factor, 1.0) << "what was one point tells no factor";
  EXPECT_EQ(pinch_between(apart, together).factor, 1.0);
}

TEST(TouchPointer, TheSurfaceStaysUnderTwoFingersThatMoveSpreadAndTwist) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 100; ++i) {
    Glass glass;
    ViewState start;
    start.rotation = turn_of({real(-1, 1), real(-1, 1), real(-1, 1)});
    start.zoom = real(0.8, 2);
    start.pan = {real(-0.2, 0.2), real(-0.2, 0.2)};
    glass.navigator.go_to(start, glass.now, false);
    const Complex a(real(-0.3, -0.05), real(-0.3, 0.3)), b(real(0.05, 0.3), real(-0.3, 0.3));
    const Complex turn = std::polar(real(0.6, 1.6), real(-2, 2)), shift(real(-0.1, 0.1), real(-0.1, 0.1));
    // The places of the object that are under the fingers, on a plane through its centre.
    const auto place = [&](const Complex& at) {
      return glm::conjugate(start.rotation) * (glm::dvec3(of(at) - start.pan, 0.0) / start.zoom);
    };
    glass.fingers = {{1, of(a)}, {2, of(b)}};
    glass.report();
    double worst = 0.0;
    for (int k = 1; k <= 50; ++k) {
      const Complex step = std::polar(std::pow(std::abs(turn), k / 50.0), std::arg(turn) * k / 50.0);
      const Complex by = shift * (k / 50.0);
      glass.fingers = {{1, of(step * a + by)}, {2, of(step * b + by)}};
      glass.report();
      worst = std::max({worst, glm::distance(seen(glass.view(), place(a)), glass.fingers[1]),
                        glm::distance(seen(glass.view(), place(b)), glass.fingers[2])});
    }
    EXPECT_LT(worst, 1e-9) << "seed " << seed;
    EXPECT_NEAR(glass.view().zoom, start.zoom * std::abs(turn), 1e-9);
    const glm::dquat rolled = turn_of({0, 0, std::arg(turn)}) * start.rotation;
    EXPECT_LT(turn_between_deg(glass.view().rotation, rolled), 1e-5) << "about the axis of sight alone";
    EXPECT_EQ(glass.navigator.movement(), 1U) << "one step to undo";
  }
}

TEST(TouchPointer, FingersThatComeOrGoMoveNothing) {
  Glass glass;
  glass.fingers = {{1, {-0.1, 0.0}}, {2, {0.1, 0.0}}};
  glass.report();
  glass.fingers = {{1, {-0.15, 0.05}}, {2, {0.1, 0.1}}};
  glass.report();
  const auto same = [](const ViewState& a, const ViewState& b) {
    return turn_between_deg(a.rotation, b.rotation) < 1e-9 && std::abs(a.zoom - b.zoom) < 1e-12 &&
           glm::distance(a.pan, b.pan) < 1e-12;  // but for rounding
  };
  ViewState before = glass.view();
  EXPECT_GT(before.zoom, 1.0);
  glass.fingers[3] = {0.4, -0.4};
  glass.report();
  EXPECT_TRUE(same(glass.view(), before)) << "a third finger comes";
  glass.fingers.erase(1);
  glass.report();
  EXPECT_TRUE(same(glass.view(), before)) << "the first goes";
  glass.fingers[7] = {0.0, 0.3};
  glass.fingers.erase(2);
  glass.report();
  EXPECT_TRUE(same(glass.view(), before)) << "one for another";
  glass.fingers = {{3, {0.4, -0.4}}};
  glass.report();
  EXPECT_TRUE(same(glass.view(), before)) << "one stays";
  glass.fingers[3] += glm::dvec2(0.004, 0.0);
  glass.report();
  glass.rest(1000 * kMs);
  EXPECT_TRUE(same(glass.view(), before)) << "and rolls a little as it is lifted";
  glass.fingers.clear();
  glass.report();
  EXPECT_TRUE(same(glass.view(), before));
  EXPECT_EQ(glass.count(EventKind::kButton, true), 0) << "and nothing was clicked";
  EXPECT_EQ(glass.events.back().kind, EventKind::kPinch);
  EXPECT_FALSE(glass.events.back().down);
}

TEST(TouchPointer, AFingerThatStayedBehindTurnsFromWhereItIs) {
  Glass glass;
  glass.fingers = {{1, {-0.1, 0.0}}, {2, {0.1, 0.0}}};
  glass.report();
  glass.fingers = {{1, {0.0, 0.0}}};
  glass.report();
  const glm::dquat before = glass.view().rotation;
  glass.fingers[1] = {0.05, 0.0};  // the first step takes hold, 50 thousandths from where it stayed
  glass.report();
  EXPECT_EQ(glass.view().rotation, before);
  glass.fingers[1] = {0.15, 0.0};
  glass.report();
  // 0.1 heights of the window are 90 pixels of a usual one, 0.4 degrees each
  EXPECT_NEAR(turn_between_deg(glass.view().rotation, before), 36.0, 1e-6);
}

TEST(TouchPointer, OneFingerTurnsAsADragDoesAndTheSurfaceFollowsIt) {
  Glass glass;
  const glm::dvec3 eye(0, 0, 3);
  glass.lever = 0.3;
  glass.eye = eye;
  const glm::dvec2 from(0.0, 0.0);
  glass.fingers = {{1, from}};
  glass.report();
  for (int k = 1; k <= 20; ++k) {
    glass.fingers[1] = {0.005 * k, 0.002 * k};
    glass.report();
  }
  const glm::dvec3 held = glass.view().rotation * glm::dvec3(0, 0, 0.3);
  const glm::dvec2 at = glm::dvec2(held) * (eye.z / (eye.z - held.z));
  EXPECT_NEAR(glm::distance(at, glass.fingers[1]), 0.0, 1e-9);
  EXPECT_EQ(glass.events.front().at, from) << "held where it came down, though it had moved before that was clear";
  glass.fingers.clear();
  glass.report();
  EXPECT_EQ(glass.count(EventKind::kButton, true), 1);
  EXPECT_EQ(glass.count(EventKind::kButton, false), 1);
  EXPECT_EQ(glass.view().zoom, 1.0);
}

TEST(TouchPointer, ATapIsAClickAndTwoBringWhatIsUnderThemToTheMiddle) {
  Glass glass;
  for (int tap = 0; tap < 2; ++tap) {
    glass.fingers = {{static_cast<std::uint32_t>(tap), {0.2 + 0.01 * tap, 0.1}}};
    glass.report(false, 100 * kMs);
    glass.report(false, 50 * kMs);
    EXPECT_EQ(glass.count(EventKind::kButton, true), tap) << "it is not known yet whether others come";
    glass.fingers.clear();
    glass.report();
    EXPECT_EQ(glass.count(EventKind::kButton, true), tap + 1);
    EXPECT_EQ(glass.count(EventKind::kButton, false), tap + 1);
  }
  EXPECT_EQ(glass.count(EventKind::kMotion, false), 0);
  for (int i = 0; i < 200; ++i) glass.rest(10 * kMs);
  EXPECT_NEAR(glm::distance(glass.view().pan, glm::dvec2(-0.21, -0.1)), 0.0, 1e-9);
}

TEST(TouchPointer, AFingerThatRestsIsAButtonThatIsHeld) {
  Glass glass;
  glass.fingers = {{1, {0.0, 0.0}}};
  glass.report();
  glass.rest(149 * kMs);
  EXPECT_TRUE(glass.events.empty());
  glass.rest(1 * kMs);
  ASSERT_EQ(glass.events.size(), 1U);
  EXPECT_TRUE(glass.events[0].down);
  EXPECT_TRUE(glass.events[0].touched);
}

TEST(TouchPointer, WhatWasHeldIsLetGoOfWithoutAClickWhenASecondFingerComes) {
  Glass glass;
  glass.fingers = {{1, {0.0, 0.0}}};
  glass.report();
  glass.rest(200 * kMs);
  glass.fingers[2] = {0.2, 0.0};
  glass.report();
  ASSERT_EQ(glass.events.size(), 3U);
  EXPECT_FALSE(glass.events[1].down);
  EXPECT_FALSE(glass.events[1].at) << "a release without a place clicks nothing";
  EXPECT_EQ(glass.events[2].kind, EventKind::kPinch);
}

TEST(TouchPointer, FingersThatAreGoneWithoutBeingLiftedClickNothing) {
  for (const TimestampNs before : {50 * kMs, 500 * kMs}) {
    Glass glass;
    glass.fingers = {{1, {0.0, 0.0}}};
    glass.report();
    glass.rest(before);
    glass.fingers.clear();
    glass.report(true);
    for (const InputEvent& event : glass.events) EXPECT_TRUE(event.down || !event.at);
    EXPECT_EQ(glass.count(EventKind::kButton, true), glass.count(EventKind::kButton, false));
  }
}

TEST(TouchPointer, AFingerThatCameDownBesideTheWindowDoesNotCountWhereverItGoes) {
  Glass glass;
  glass.fingers = {{1, {0.9, 0.0}}};
  glass.report();
  glass.fingers[1] = {0.1, 0.0};
  glass.report();
  glass.report();
  EXPECT_TRUE(glass.events.empty());
  glass.fingers[2] = {0.0, 0.0};
  glass.report();
  glass.fingers[2] = {0.85, 0.0};  // one that came down on it may leave it
  glass.report();
  EXPECT_EQ(glass.count(EventKind::kPinch, true), 0);
  EXPECT_EQ(glass.count(EventKind::kMotion, false), 1);
}

TEST(TouchPointer, RandomFingersNeverLeaveAButtonDownNorMakeNumbersThatAreNone) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  Glass glass;
  for (int i = 0; i < 20'000; ++i) {
    for (std::uint32_t id = 0; id < 6; ++id) {
      const auto kind = random() % 6;
      if (kind == 0) glass.fingers.erase(id);
      if (kind == 1)
        glass.fingers[id] = {static_cast<double>(random() % 100) / 50 - 1,
                             static_cast<double>(random() % 100) / 100 - .5};
      if (kind == 2 && glass.fingers.count(id) > 0) glass.fingers[id] += glm::dvec2(0.001, 0.001);
    }
    if (i % 50 == 0) glass.fingers.clear();
    glass.report(random() % 5 == 0, static_cast<TimestampNs>(random() % 100) * kMs);
    const ViewState& view = glass.view();
    ASSERT_TRUE(std::isfinite(view.pan.x) && std::isfinite(view.pan.y) && std::isfinite(view.rotation.w))
        << "seed " << seed;
    ASSERT_GE(view.zoom, glass.mapping.zoom_min);
    ASSERT_LE(view.zoom, glass.mapping.zoom_max);
    if (glass.fingers.empty()) {
      ASSERT_EQ(glass.count(EventKind::kButton, true), glass.count(EventKind::kButton, false)) << "seed " << seed;
      glass.events.clear();
    }
  }
}

}  // namespace
}  // namespace dubsar
