// Gestures as galleries have them, where nobody was told.

#include <gtest/gtest.h>

#include "input/navigation/mapping.h"
#include "tests/input/gestures/gesture_person.h"

namespace dubsar::test {
namespace {

/// As galleries have it, where nobody was told.
GestureOptions gallery() { return gallery_mapping().value().gestures; }

TEST(GestureInGalleries, AHandThatClosesAtRestTakesHoldAndOneThatClosesOnItsWayMustOpenFirst) {
  Person rests{gallery()}, walks{gallery()};
  rests.steps(60);
  rests.hand.grab_strength = 1.0;
  rests.steps(5);
  EXPECT_FALSE(rests.recognizer.grabbing()) << "not sure yet";
  rests.steps(10);
  EXPECT_TRUE(rests.recognizer.grabbing());
  walks.steps(60);
  walks.move({0.4, 0.0, 0.0}, 15);
  walks.hand.grab_strength = 1.0;
  walks.move({0.4, 0.0, 0.0}, 15);
  walks.steps(200);
  EXPECT_FALSE(walks.recognizer.grabbing());
  walks.hand.grab_strength = 0.2;
  walks.steps(20);
  walks.hand.grab_strength = 1.0;
  walks.steps(20);
  EXPECT_TRUE(walks.recognizer.grabbing());
}

TEST(GestureInGalleries, FingersThatCloseAsTheHandGoesToTheChinTakeNoHoldThere) {
  Person p{gallery()};
  set_index(p.hand, 0.045);
  p.hand.grab_strength = 0.12;
  p.steps(60);
  for (int i = 0; i < 40; ++i) {
    p.hand.grab_strength = 0.12 + 0.012 * (i + 1);
    p.move({0.0, 0.5, 0.2}, 1);
  }
  p.steps(200);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), 0);
  p.hand.grab_strength = 0.12;
  p.steps(50);
  p.hand.grab_strength = 0.6;
  p.steps(20);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), 1) << "who opens and closes it there takes hold";
}

TEST(GestureInGalleries, WhatATrackerMisreadsForFiveHundredthsOfASecondNeitherTakesHoldNorLetsGo) {
  Person p{gallery()};
  for (int i = 0; i < 20; ++i) {
    p.hand.grab_strength = 0.1;
    p.steps(40);
    p.hand.grab_strength = 1.0;
    p.steps(5);
  }
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), 0);
  p.hand.grab_strength = 0.1;
  p.steps(40);
  p.hand.grab_strength = 1.0;
  p.steps(20);
  for (int i = 0; i < 10; ++i) {
    p.hand.grab_strength = 0.2;
    p.steps(5);
    p.hand.grab_strength = 1.0;
    p.steps(20);
  }
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), 1);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kEnd), 0);
}

TEST(GestureInGalleries, ASwipeGoesFromRestAndAHandThatComesLeavesOrTalksDoesNotSwipe) {
  Person wipes{gallery()};
  wipes.hand.palm.position_m.x = -0.12;
  wipes.steps(260);
  wipes.move({1.0, 0.0, 0.0}, 20);
  wipes.steps(30);
  EXPECT_EQ(wipes.count(GestureKind::kSwipe, GesturePhase::kDone), 1);
  Person comes{gallery()};
  comes.hand.palm.position_m = {-0.3, -0.2, 0.3};
  comes.move({1.0, 0.3, 0.0}, 40);  // never at rest before
  comes.steps(30);
  EXPECT_EQ(comes.count(GestureKind::kSwipe, GesturePhase::kDone), 0);
  Person leaves{gallery()};
  leaves.steps(260);
  leaves.move({0.0, -0.9, 0.6}, 30);  // down and to the body
  leaves.steps(30, false);
  EXPECT_EQ(leaves.count(GestureKind::kSwipe, GesturePhase::kDone), 0);
  Person talks{gallery()};
  talks.steps(260);
  for (int i = 0; i < 20; ++i) talks.move({i % 2 == 0 ? 0.5 : -0.5, 0.05, 0.0}, 30);
  EXPECT_EQ(talks.count(GestureKind::kSwipe, GesturePhase::kDone), 0);
}

TEST(GestureInGalleries, OneWhoHasJustReachedInWipesNothing) {
  Person reaches{gallery()};
  reaches.hand.palm.position_m.x = -0.12;
  reaches.steps(200);
  reaches.move({1.0, 0.0, 0.0}, 20);
  reaches.steps(30);
  EXPECT_EQ(reaches.count(GestureKind::kSwipe, GesturePhase::kDone), 0);
}

TEST(GestureInGalleries, ASlowPushOfAnOpenHandIsASwipeAndThatOfAHandThatTalksIsNone) {
  for (const double closed : {0.1, 0.25}) {  // on its way; the hand was as open as it gets
    Person p{gallery()};
    p.hand.palm.position_m.x = -0.12;
    p.hand.grab_strength = 0.1;
    p.steps(260);
    p.hand.grab_strength = closed;
    p.move({0.55, 0.0, 0.0}, 35);
    p.steps(30);
    EXPECT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), closed < 0.2 ? 1 : 0) << closed;
  }
}

TEST(GestureInGalleries, NothingButRestingBeginsAtTheSigns) {
  Person p{gallery()};
  p.hand.palm.position_m = {0.33, 0.3, 0.3};
  p.steps(60);
  p.hand.grab_strength = 1.0;
  p.steps(30);
  EXPECT_FALSE(p.recognizer.grabbing());
}

}  // namespace
}  // namespace dubsar::test
