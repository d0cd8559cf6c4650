#include "input/gestures/gesture.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "tests/input/gestures/gesture_person.h"

namespace dubsar::test {
namespace {

TEST(Gesture, GrabBeginsAtEightTenthsAndEndsAtSeven) {
  Person p;
  p.steps(40);
  p.hand.grab_strength = 0.79;
  p.steps(20);
  EXPECT_FALSE(p.recognizer.grabbing());
  p.hand.grab_strength = 0.80;
  p.step();
  EXPECT_TRUE(p.recognizer.grabbing());
  p.hand.grab_strength = 0.71;
  p.steps(20);
  EXPECT_TRUE(p.recognizer.grabbing());
  p.hand.grab_strength = 0.70;
  p.step();
  EXPECT_FALSE(p.recognizer.grabbing());
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), 1);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kEnd), 1);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kCancel), 0);
}

TEST(Gesture, StrengthThatTremblesBetweenTheThresholdsGrabsOnce) {
  Person p;
  p.steps(40);
  for (int i = 0; i < 100; ++i) {
    p.hand.grab_strength = i % 2 == 0 ? 0.81 : 0.72;
    p.step();
  }
  EXPECT_EQ(p.events.size(), 1u);
}

TEST(Gesture, PinchBeginsAtTwentyFiveMillimetresAndEndsAtThirty) {
  Person p;
  p.steps(40);
  p.hand.pinch_distance_m = 0.0251;
  p.steps(20);
  EXPECT_FALSE(p.recognizer.pinching());
  p.hand.pinch_distance_m = 0.025;
  p.step();
  EXPECT_TRUE(p.recognizer.pinching());
  p.hand.pinch_distance_m = 0.0299;
  p.steps(20);
  EXPECT_TRUE(p.recognizer.pinching());
  p.hand.pinch_distance_m = 0.030;
  p.step();
  EXPECT_FALSE(p.recognizer.pinching());
  EXPECT_EQ(p.count(GestureKind::kPinch, GesturePhase::kEnd), 1);
}

TEST(Gesture, GrabMasksPinch) {
  Person p;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.hand.pinch_distance_m = 0.01;  // a fist's thumb touches the index finger
  p.steps(20);
  EXPECT_TRUE(p.recognizer.grabbing());
  EXPECT_EQ(p.count(GestureKind::kPinch, GesturePhase::kBegin), 0);
  p.hand.grab_strength = 0.5;  // opening, thumb and index still together
  p.steps(20);
  EXPECT_EQ(p.count(GestureKind::kPinch, GesturePhase::kBegin), 0);
}

TEST(Gesture, AGrabTakesOverFromAPinchByCancellingIt) {
  Person p;
  p.steps(40);
  p.hand.pinch_distance_m = 0.02;
  p.steps(5);
  EXPECT_TRUE(p.recognizer.pinching());
  p.hand.grab_strength = 0.9;
  p.step();
  EXPECT_TRUE(p.recognizer.grabbing());
  EXPECT_FALSE(p.recognizer.pinching());
  EXPECT_EQ(p.count(GestureKind::kPinch, GesturePhase::kCancel), 1);
  EXPECT_EQ(p.count(GestureKind::kPinch, GesturePhase::kEnd), 0);
}

TEST(Gesture, AHandThatHoldsTheAirAsAnObjectGrabsAndLetsGoWhenItOpens) {
  Person p{GestureOptions{}};
  set_index(p.hand, 0.045);
  p.hand.grab_strength = 0.2;
  p.steps(60);
  p.hand.grab_strength = 0.46;
  p.steps(5);
  EXPECT_FALSE(p.recognizer.grabbing()) << "closed by less than 0.28";
  p.hand.grab_strength = 0.62;
  p.step();
  EXPECT_TRUE(p.recognizer.grabbing());
  p.move({0.3, 0.0, 0.0}, 30);
  EXPECT_TRUE(p.recognizer.grabbing());
  p.hand.grab_strength = 0.41;
  p.step();
  EXPECT_FALSE(p.recognizer.grabbing());
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kEnd), 1);
}

TEST(Gesture, ClosingAHandOnItsWayAndPointingAreNotGrabs) {
  Person walks{GestureOptions{}}, points{GestureOptions{}};
  set_index(walks.hand, 0.045);
  walks.hand.grab_strength = points.hand.grab_strength = 0.1;
  walks.steps(60);
  walks.move({0.4, 0.0, 0.0}, 10);
  walks.hand.grab_strength = 0.6;
  walks.move({0.4, 0.0, 0.0}, 20);
  EXPECT_FALSE(walks.recognizer.grabbing());
  set_index(points.hand, 0.07);
  points.steps(60);
  points.hand.grab_strength = 0.7;
  points.steps(30);
  EXPECT_FALSE(points.recognizer.grabbing());
}

TEST(Gesture, NothingBeginsWithin300MsOfAHandsArrival) {
  Person p;
  p.steps(5);
  p.hand.grab_strength = 1.0;
  for (int i = 0; i < 26; ++i) {  // hand first seen at 10 ms: 300 ms are over at 310 ms
    p.step();
    if (p.now < 310 * kMs) {
      EXPECT_FALSE(p.recognizer.grabbing()) << p.now;
    }
  }
  EXPECT_TRUE(p.recognizer.grabbing());
}

TEST(Gesture, AFistThatComesInHasToOpenFirst) {
  Person p;
  p.hand.grab_strength = 1.0;
  p.steps(100);
  EXPECT_FALSE(p.recognizer.grabbing());
  p.hand.grab_strength = 0.2;
  p.steps(5);
  p.hand.grab_strength = 1.0;
  p.steps(5);
  EXPECT_TRUE(p.recognizer.grabbing());
}

TEST(Gesture, ALostHandCancelsAndNeverEnds) {
  Person p;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.steps(10);
  p.steps(10, false);  // 100 ms: still held
  EXPECT_TRUE(p.recognizer.grabbing());
  p.step(false);
  EXPECT_FALSE(p.recognizer.grabbing());
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kCancel), 1);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kEnd), 0);
  p.steps(100);  // back, still a fist
  EXPECT_FALSE(p.recognizer.grabbing());
}

TEST(Gesture, AShortDropoutKeepsTheGrab) {
  Person p;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.steps(10);
  p.steps(9, false);
  p.steps(10);
  EXPECT_TRUE(p.recognizer.grabbing());
  EXPECT_EQ(p.events.size(), 1u);
}

TEST(Gesture, AHandThatIsOnlyPredictedCountsAsMissing) {
  Person p;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.steps(10);
  p.hand.tracked = false;
  p.steps(12);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kCancel), 1);
}

TEST(Gesture, AFrameThatIsRepeatedForEverIsALostHand) {
  Person p;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.steps(10);
  for (int i = 0; i < 12; ++i) {
    p.now += kStep;
    p.recognizer.update(p.now, &p.hand);
  }
  EXPECT_FALSE(p.recognizer.grabbing());
}

TEST(Gesture, SwipesToAllFourSides) {
  const std::array<std::pair<glm::dvec3, SwipeDirection>, 4> cases{{{{-0.9, 0, 0}, SwipeDirection::kLeft},
                                                                    {{0.9, 0, 0}, SwipeDirection::kRight},
                                                                    {{0, 0.9, 0}, SwipeDirection::kUp},
                                                                    {{0, -0.9, 0}, SwipeDirection::kDown}}};
  for (const auto& [velocity, direction] : cases) {
    Person p;
    p.steps(40);
    p.move(velocity, 20);
    ASSERT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), 1);
    EXPECT_EQ(p.events.back().direction, direction);
  }
}

TEST(Gesture, SlowSlantedAndGrabbingHandsDoNotSwipe) {
  for (const glm::dvec3 velocity : {glm::dvec3(0.60, 0, 0), glm::dvec3(0.9, 0.4, 0), glm::dvec3(0.9, 0, 0.4)}) {
    Person p;
    p.steps(40);
    p.move(velocity, 30);
    EXPECT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), 0)
        << velocity.x << " " << velocity.y << " " << velocity.z;
  }
  Person p;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.steps(5);
  p.move({0.9, 0, 0}, 30);
  EXPECT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), 0);
}

TEST(Gesture, TheWayBackAfterASwipeIsNoSwipe) {
  Person p;
  p.steps(40);
  p.move({0.9, 0, 0}, 60);   // longer than the lock-out
  p.move({-0.9, 0, 0}, 60);  // straight back
  EXPECT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), 1);
  p.steps(20);  // rest
  p.move({-0.9, 0, 0}, 20);
  EXPECT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), 2);
}

TEST(Gesture, DwellTakesElevenTenthsOfASecondAndHappensOnceARest) {
  Person p;
  p.move({0.2, 0, 0}, 40);
  const TimestampNs rest = p.now;
  while (p.count(GestureKind::kDwell, GesturePhase::kDone) == 0 && p.now - rest < 3000 * kMs) p.step();
  EXPECT_NEAR(static_cast<double>(p.now - rest) / kMs, 1100, 100);  // the dwell begins up to 15 mm before the rest
  p.steps(300);
  EXPECT_EQ(p.count(GestureKind::kDwell, GesturePhase::kDone), 1);
  p.move({0.2, 0, 0}, 30);
  p.steps(150);
  EXPECT_EQ(p.count(GestureKind::kDwell, GesturePhase::kDone), 2);
}

TEST(Gesture, AClockThatIsSetBackEndsAHoldAndTheNextHandIsSeenAtOnce) {
  Person p;
  p.now = 600'000 * kMs;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.steps(20);
  ASSERT_TRUE(p.recognizer.grabbing());
  p.now -= 300'000 * kMs;
  p.hand.grab_strength = 0.0;
  p.step();
  EXPECT_TRUE(p.recognizer.seen_now());
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kCancel), 1) << "a lost hand throws nothing";
  p.steps(60);
  p.hand.grab_strength = 1.0;
  p.steps(20);
  EXPECT_TRUE(p.recognizer.grabbing());
}

}  // namespace
}  // namespace dubsar::test
