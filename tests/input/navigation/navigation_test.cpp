#include "input/navigation/navigation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "input/people/person_keeper.h"
#include "tests/input/milliseconds.h"
#include "tests/input/navigation/turns.h"

namespace dubsar {
namespace {
using test::about;
using test::kRad;

using test::kMs;
constexpr TimestampNs kFrame = 10 * kMs;

/// A desk with everything on it, 100 frames a second.
struct Desk {
  Mapping mapping = default_mapping().value();
  Navigator navigator{mapping};
  PersonKeeper people;
  InputFrame frame;
  TimestampNs now = 0;
  double largest_step_deg = 0.0;

  explicit Desk(std::string_view changes = "{}")
      : mapping(parse_mapping(changes, "test").value()), navigator(mapping) {}

  void step() {
    now += kFrame;
    frame.time = now;
    for (HandFrame& hand : frame.hands) hand.time = now;
    const glm::dquat before = navigator.view().rotation;
    navigator.update(now, frame, people.update(now, frame).hands);
    largest_step_deg = std::max(largest_step_deg, turn_between_deg(before, navigator.view().rotation));
    frame.events.clear();
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) step();
  }
  std::size_t add_hand(Chirality side, const glm::dvec3& at) {
    HandFrame hand;
    hand.id = static_cast<std::uint32_t>(frame.hands.size() + 1);
    hand.chirality = side;
    hand.valid = hand.tracked = true;
    hand.palm.position_m = at;
    frame.hands.push_back(hand);
    steps(40);
    return frame.hands.size() - 1;
  }
  void move(std::size_t hand, const glm::dvec3& by, int n) {
    for (int i = 0; i < n; ++i) {
      frame.hands[hand].palm.position_m += by / static_cast<double>(n);
      step();
    }
  }
  void button(MouseButton which, bool down, std::uint8_t modifiers = 0) {
    frame.events.push_back({now, EventKind::kButton, {}, which, down, modifiers, {}});
    step();
  }
  void motion(const glm::dvec2& px, std::uint8_t modifiers = 0) {
    frame.events.push_back({now, EventKind::kMotion, px, {}, false, modifiers, {}});
    step();
  }
  void wheel(double notches, std::optional<glm::dvec2> at = {}) {
    frame.events.push_back({now, EventKind::kWheel, {0, notches}, {}, false, 0, {}, false, at});
    step();
  }
  void press(const glm::dvec2& at) {
    frame.events.push_back({now, EventKind::kButton, {}, MouseButton::kLeft, true, 0, {}, false, at});
    step();
  }
  const ViewState& view() const { return navigator.view(); }
};

TEST(Navigation, MouseTurnsMovesAndZoomsAsInThePaper) {
  Desk desk;
  desk.button(MouseButton::kLeft, true);
  desk.motion({50, 0});
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 1, 0}, 20)), 0, 1e-6);  // 0.4 degrees a pixel
  desk.button(MouseButton::kLeft, false);
  desk.motion({50, 0});
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 1, 0}, 20)), 0, 1e-6);
  desk.button(MouseButton::kLeft, true, kShift);
  desk.motion({90, -45}, kShift);
  desk.button(MouseButton::kLeft, false);
  EXPECT_NEAR(desk.view().pan.x, 0.1, 1e-12);
  EXPECT_NEAR(desk.view().pan.y, 0.05, 1e-12);
  desk.button(MouseButton::kLeft, true, kControl);
  desk.motion({0, -100}, kControl);
  desk.button(MouseButton::kLeft, false);
  EXPECT_NEAR(desk.view().zoom, 1.6, 1e-12);
}

TEST(Navigation, MouseDownwardsTiltsTheTopTowardsTheViewer) {
  Desk desk;
  desk.button(MouseButton::kLeft, true);
  desk.motion({0, 50});
  const glm::dvec3 top = desk.view().rotation * glm::dvec3(0, 1, 0);
  EXPECT_GT(top.z, 0.3);
}

TEST(Navigation, GrabbingTurnsTheObjectWithTheHand) {
  Desk desk;
  const auto hand = desk.add_hand(Chirality::kRight, {0, 0, 0.3});
  desk.frame.hands[hand].grab_strength = 1.0;
  desk.steps(5);
  desk.move(hand, {0.010, 0, 0}, 20);  // the dead zone
  desk.move(hand, {0.060, 0, 0}, 60);
  desk.steps(100);
  const glm::dvec3 front = desk.view().rotation * glm::dvec3(0, 0, 1);
  EXPECT_GT(front.x, 0.4);
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 1, 0}, 30)), 0, 1.5);  // 60 mm at 0.5 degrees
  EXPECT_LE(desk.largest_step_deg, 2.0);
}

TEST(Navigation, AHandThatJumpsDoesNotMakeTheViewJump) {
  Desk desk;
  const auto hand = desk.add_hand(Chirality::kRight, {0, 0, 0.3});
  desk.frame.hands[hand].grab_strength = 1.0;
  desk.steps(5);
  desk.move(hand, {0.02, 0, 0}, 10);
  desk.frame.hands[hand].palm.position_m.x += 0.25;
  desk.steps(100);
  EXPECT_LE(desk.largest_step_deg, 2.0);
  EXPECT_GT(turn_between_deg(desk.view().rotation, {1, 0, 0, 0}), 10.0);
}

TEST(Navigation, ThrowingGlidesOnAndLosingTheHandDoesNot) {
  for (const bool lost : {false, true}) {
    Desk desk;
    const auto hand = desk.add_hand(Chirality::kRight, {-0.05, 0, 0.3});
    desk.frame.hands[hand].grab_strength = 1.0;
    desk.steps(5);
    desk.move(hand, {0.06, 0, 0}, 40);  // 150 mm/s
    if (lost) {
      desk.frame.hands.clear();
    } else {
      desk.frame.hands[hand].grab_strength = 0.0;
    }
    desk.steps(lost ? 12 : 6);
    const glm::dquat at_release = desk.view().rotation;
    desk.steps(300);
    const double glided = turn_between_deg(at_release, desk.view().rotation);
    if (lost) {
      EXPECT_LT(glided, 0.01);
    } else {
      EXPECT_GT(glided, 8.0);  // 75 degrees/s for 0.35 s would be 26
      EXPECT_LT(glided, 35.0);
    }
  }
}

TEST(Navigation, TwoHandsZoomAndRoll) {
  Desk desk;
  const auto right = desk.add_hand(Chirality::kRight, {0.1, 0, 0.3});
  const auto left = desk.add_hand(Chirality::kLeft, {-0.1, 0, 0.3});
  desk.frame.hands[right].grab_strength = desk.frame.hands[left].grab_strength = 1.0;
  desk.steps(5);
  for (int i = 0; i < 100; ++i) {
    desk.frame.hands[right].palm.position_m.x += 0.0005;
    desk.frame.hands[left].palm.position_m.x -= 0.0005;
    desk.step();
  }
  desk.steps(30);
  EXPECT_NEAR(desk.view().zoom, 0.300 / 0.210, 0.02);  // 200 to 300 mm, less 10 mm of dead zone
  EXPECT_LT(turn_between_deg(desk.view().rotation, {1, 0, 0, 0}), 0.2);
  const double zoom = desk.view().zoom;
  for (int i = 1; i <= 100; ++i) {
    const double angle = 0.36 * i * kRad;
    desk.frame.hands[right].palm.position_m = {0.15 * std::cos(angle), 0.15 * std::sin(angle), 0.3};
    desk.frame.hands[left].palm.position_m = {-0.15 * std::cos(angle), -0.15 * std::sin(angle), 0.3};
    desk.step();
  }
  desk.steps(30);
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 0, 1}, 30)), 0, 1.0);  // 36 less 6
  EXPECT_NEAR(desk.view().zoom, zoom, 0.02 * zoom);
  EXPECT_LE(desk.largest_step_deg, 2.0);
}

TEST(Navigation, TheHandThatStaysClosedAfterTwoHandsDoesNotTurnTheObject) {
  Desk desk;
  const auto right = desk.add_hand(Chirality::kRight, {0.1, 0, 0.3});
  const auto left = desk.add_hand(Chirality::kLeft, {-0.1, 0, 0.3});
  desk.frame.hands[right].grab_strength = desk.frame.hands[left].grab_strength = 1.0;
  desk.steps(5);
  desk.frame.hands[left].grab_strength = 0.0;
  desk.steps(5);
  desk.move(right, {0.1, 0.05, 0}, 50);
  EXPECT_LT(turn_between_deg(desk.view().rotation, {1, 0, 0, 0}), 0.01);
  desk.frame.hands[right].grab_strength = 0.0;
  desk.steps(5);
  desk.frame.hands[right].grab_strength = 1.0;
  desk.steps(5);
  desk.move(right, {-0.1, 0, 0}, 50);
  EXPECT_GT(turn_between_deg(desk.view().rotation, {1, 0, 0, 0}), 20.0);
}

TEST(Navigation, PinchingMovesTheLightOnly) {
  Desk desk;
  const auto hand = desk.add_hand(Chirality::kRight, {0, 0, 0.3});
  desk.frame.hands[hand].pinch_distance_m = 0.01;
  desk.steps(5);
  desk.move(hand, {0.05, 0.05, 0}, 50);
  desk.steps(30);
  EXPECT_NEAR(desk.view().light_azimuth_deg, 315 + 30, 0.5);
  EXPECT_NEAR(desk.view().light_elevation_deg, 25 + 30, 0.5);
  EXPECT_EQ(desk.view().rotation, ViewState().rotation);
}

TEST(Navigation, ASwipeTurnsToTheNextSideFromAnywhere) {
  Desk desk;
  desk.button(MouseButton::kLeft, true);
  desk.motion({40, 20});
  desk.button(MouseButton::kLeft, false);
  desk.steps(50);
  desk.largest_step_deg = 0;
  const auto hand = desk.add_hand(Chirality::kRight, {-0.1, 0, 0.3});
  desk.move(hand, {0.15, 0, 0}, 16);
  desk.steps(300);
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 1, 0}, 90)), 0, 1e-3);
  EXPECT_LE(desk.largest_step_deg, 2.0);
}

TEST(Navigation, CommandsJumpOrGlideToAViewAndItsGoalIsKnownAtOnce) {
  Desk desk;
  ViewState there;
  there.rotation = about({0, 1, 0}, 40);
  there.zoom = 2;
  desk.navigator.go_to(there, desk.now, false);
  desk.step();
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, there.rotation), 0, 1e-9);
  ViewState back;
  desk.navigator.go_to(back, desk.now, true);
  desk.step();
  EXPECT_GT(turn_between_deg(desk.view().rotation, {1, 0, 0, 0}), 30.0);
  EXPECT_EQ(desk.navigator.goal().rotation, back.rotation);
  desk.largest_step_deg = 0;
  desk.steps(400);
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, {1, 0, 0, 0}), 0, 1e-9);
  EXPECT_EQ(desk.view().zoom, 1.0);
  EXPECT_LE(desk.largest_step_deg, 2.0);
  EXPECT_EQ(desk.navigator.movement(), 0u) << "nobody moved anything by hand";
}

TEST(Navigation, AMouseDragAndAThrowWithItsGlideAreOneMovementEach) {
  Desk desk;
  desk.button(MouseButton::kLeft, true);
  for (int i = 0; i < 20; ++i) desk.motion({3, 1});
  desk.button(MouseButton::kLeft, false);
  EXPECT_EQ(desk.navigator.movement(), 1u);
  desk.steps(50);
  const auto hand = desk.add_hand(Chirality::kRight, {-0.05, 0, 0.3});
  desk.frame.hands[hand].grab_strength = 1.0;
  desk.steps(5);
  desk.move(hand, {0.06, 0, 0}, 40);
  desk.frame.hands[hand].grab_strength = 0.0;
  desk.steps(300);
  EXPECT_EQ(desk.navigator.movement(), 2u);
}

TEST(Navigation, WhatIsUnderThePointerStaysThereWhileTheWheelZooms) {
  Desk desk;
  const glm::dvec2 at(0.3, -0.2);
  desk.wheel(1, glm::dvec2(-0.1, 0.4));
  const glm::dvec2 point = (at - desk.view().pan) / desk.view().zoom;   // of the object, in its own heights
  for (int i = 0; i < 100; ++i) desk.wheel(i % 3 == 0 ? -1.5 : 1, at);  // past the largest zoom, too
  EXPECT_NEAR(glm::length(desk.view().pan + desk.view().zoom * point - at), 0, 1e-12);
  EXPECT_GT(desk.view().zoom, 5.0) << "one turn back from the largest zoom";
}

TEST(Navigation, TwoQuickClicksBringWhatIsPointedAtToTheMiddle) {
  Desk desk;
  const glm::dvec2 at(0.2, 0.1);
  for (int i = 0; i < 2; ++i) {
    desk.press(at);
    desk.button(MouseButton::kLeft, false);
  }
  desk.steps(200);
  EXPECT_NEAR(glm::length(desk.view().pan + at), 0, 1e-9);
}

TEST(Navigation, AMouseThatIsSwitchedOffWhileItsButtonIsDownLetsGo) {
  Desk desk;
  desk.button(MouseButton::kLeft, true);
  desk.motion({10, 0});
  desk.navigator.let_go_of_mouse();
  desk.steps(100);
  EXPECT_EQ(desk.navigator.control(), Control::kNone);
  const glm::dquat before = desk.view().rotation;
  desk.motion({50, 0});
  EXPECT_EQ(desk.view().rotation, before);
}

TEST(Navigation, TheMouseTakesTheViewFromAVisitorsFistWhichThenHasToOpen) {
  Desk desk;
  const auto hand = desk.add_hand(Chirality::kRight, {0, 0, 0.3});
  desk.frame.hands[hand].grab_strength = 1.0;
  desk.steps(5);
  desk.move(hand, {0.03, 0, 0}, 20);
  EXPECT_EQ(desk.navigator.control(), Control::kHands);
  desk.button(MouseButton::kLeft, true);
  EXPECT_EQ(desk.navigator.control(), Control::kMouse);
  const glm::dquat taken = desk.view().rotation;
  desk.move(hand, {0.05, 0, 0}, 20);
  EXPECT_EQ(desk.view().rotation, taken);
  desk.button(MouseButton::kLeft, false);
  desk.steps(50);
  desk.move(hand, {0.05, 0, 0}, 20);
  EXPECT_EQ(desk.view().rotation, taken);
}

TEST(Navigation, HandsCannotTakeTheViewFromTheMouse) {
  Desk desk;
  const auto hand = desk.add_hand(Chirality::kRight, {0, 0, 0.3});
  desk.button(MouseButton::kLeft, true);
  desk.frame.hands[hand].grab_strength = 1.0;
  desk.steps(5);
  desk.move(hand, {0.1, 0, 0}, 50);
  EXPECT_EQ(desk.view().rotation, ViewState().rotation);
}

TEST(Navigation, TheSpaceMouseTurnsAtItsRateOutsideItsDeadZone) {
  Desk desk;
  desk.frame.space_mouse = SpaceMouseMotion{0, {0, 0, 0}, {0, 1, 0}};
  desk.steps(101);  // the first step has no duration
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 1, 0}, 90)), 0, 1e-6);
  desk.frame.space_mouse = SpaceMouseMotion{0, {0, 0, 1}, {0, 0.04, 0}};
  const glm::dquat before = desk.view().rotation;
  desk.steps(100);
  EXPECT_EQ(turn_between_deg(desk.view().rotation, before), 0.0);
  EXPECT_NEAR(desk.view().zoom, 2.0, 1e-9);
}

TEST(Navigation, ZoomStaysWithinItsLimits) {
  Desk desk;
  for (int i = 0; i < 200; ++i) desk.wheel(1);
  EXPECT_DOUBLE_EQ(desk.view().zoom, 20.0);
  for (int i = 0; i < 400; ++i) desk.wheel(-1);
  EXPECT_DOUBLE_EQ(desk.view().zoom, 0.2);
}

TEST(Navigation, AMappingChangesWhatAGestureDoes) {
  Desk desk(R"({"hands": {"grab": "pan", "swipe": "none", "dwell": "reset"}})");
  const auto hand = desk.add_hand(Chirality::kRight, {0, 0, 0.3});
  desk.frame.hands[hand].grab_strength = 1.0;
  desk.steps(5);
  desk.move(hand, {0.11, 0, 0}, 50);
  desk.steps(20);
  EXPECT_NEAR(desk.view().pan.x, 0.5, 0.01);
  EXPECT_EQ(desk.view().rotation, ViewState().rotation);
  desk.frame.hands[hand].grab_strength = 0.0;
  desk.steps(400);
  EXPECT_NEAR(desk.view().pan.x, 0.0, 1e-9);
}

}  // namespace
}  // namespace dubsar
