// Gestures as galleries have them, where nobody was told.

#include <gtest/gtest.h>

#include "input/navigation/mapping.h"
#include "tests/input/gestures/gesture_person.h"

namespace dubsar::test {
namespace {

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
  wipes.standing.sure = false;
  wipes.steps(360);
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

TEST(GestureInGalleries, OneWhoHasJustReachedInWipesNothingUnlessItIsSureWhoseHandThatIs) {
  for (const bool sure : {false, true}) {
    Person reaches{gallery()};
    reaches.standing.sure = sure;
    reaches.hand.palm.position_m.x = -0.12;
    reaches.steps(130);
    reaches.move({1.0, 0.0, 0.0}, 20);
    reaches.steps(30);
    EXPECT_EQ(reaches.count(GestureKind::kSwipe, GesturePhase::kDone), sure ? 1 : 0);
  }
  for (const bool beginner : {false, true}) {
    Person doubtful{gallery()};
    doubtful.standing.doubtful = true;
    doubtful.recognizer.set_scene({.beginner = beginner});
    doubtful.hand.palm.position_m.x = -0.12;
    doubtful.steps(130);
    doubtful.move({1.0, 0.0, 0.0}, 20);
    doubtful.steps(30);
    EXPECT_EQ(doubtful.count(GestureKind::kSwipe, GesturePhase::kDone), beginner ? 1 : 0);
  }
  Person at_once{gallery()};
  at_once.hand.palm.position_m.x = -0.12;
  at_once.steps(60);
  at_once.move({1.0, 0.0, 0.0}, 20);
  at_once.steps(30);
  EXPECT_EQ(at_once.count(GestureKind::kSwipe, GesturePhase::kDone), 0) << "not even a sure one at once";
}

TEST(GestureInGalleries, AHandThatDriftsAsItClosesTakesHoldWhenItIsStill) {
  Person p{gallery()};
  p.steps(60);
  p.move({0.09, 0.0, 0.0}, 40);  // sinks or comes to rest: 20 mm every quarter of a second
  p.hand.grab_strength = 1.0;
  p.move({0.09, 0.0, 0.0}, 10);
  p.steps(40);
  EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), 1);
}

TEST(GestureInGalleries, AHandThatMayBeSomebodyElsesRestsUntilItHolds) {
  for (const bool sure : {false, true}) {
    Person p{gallery()};
    p.standing.sure = sure;
    p.steps(150);
    p.hand.grab_strength = 1.0;
    p.move({0.0, 0.0, -0.22}, 9);  // within 20 mm, as one lunges
    p.steps(40);
    EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), sure ? 1 : 0);
  }
}

TEST(GestureInGalleries, AHandThatHasJustComeRestsUntilItHoldsUnlessNothingWasTurnedYet) {
  for (const bool beginner : {false, true}) {
    Person p{gallery()};
    p.recognizer.set_scene({.beginner = beginner});
    p.steps(60);
    p.hand.grab_strength = 1.0;
    p.move({0.0, 0.0, -0.22}, 9);
    p.steps(40);
    EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), beginner ? 1 : 0);
  }
  Person rests{gallery()};
  rests.steps(60);
  rests.hand.grab_strength = 1.0;
  rests.steps(40);
  EXPECT_EQ(rests.count(GestureKind::kGrab, GesturePhase::kBegin), 1);
}

TEST(GestureInGalleries, AHandAtTheOwnFaceNeitherTakesHoldNorWipes) {
  for (const bool at_face : {false, true}) {
    Person p{gallery()};
    p.standing.at_face = at_face;
    p.hand.grab_strength = 0.1;
    p.hand.palm.position_m.x = -0.12;
    p.steps(260);
    p.move({1.0, 0.0, 0.0}, 20);
    p.steps(60);
    p.hand.grab_strength = 1.0;
    p.steps(30);
    EXPECT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), at_face ? 0 : 1);
    EXPECT_EQ(p.count(GestureKind::kGrab, GesturePhase::kBegin), at_face ? 0 : 1);
  }
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
  for (const bool signs : {true, false}) {
    Person p{gallery()};
    p.recognizer.set_scene({.signs_above = signs});
    p.hand.palm.position_m = {0.33, 0.3, 0.3};
    p.steps(60);
    p.hand.grab_strength = 1.0;
    p.steps(30);
    EXPECT_NE(p.recognizer.grabbing(), signs);
  }
}

TEST(GestureInGalleries, ABeginnersFingersMayTrembleAsTheyTakeHold) {
  for (const bool beginner : {true, false}) {
    Person p{gallery()};
    p.recognizer.set_scene({.beginner = beginner});
    p.hand.grab_strength = 0.3;
    p.steps(100);
    for (int i = 0; i < 30; ++i) {
      p.hand.grab_strength = i % 3 == 0 ? 0.61 : 0.55;
      p.step();
    }
    EXPECT_EQ(p.recognizer.grabbing(), beginner);
  }
}

TEST(GestureInGalleries, WhatOneHandBeganAnotherOneDoesNotWipe) {
  for (const bool same : {true, false}) {
    Person p{gallery()};
    p.hand.grab_strength = 0.1;
    p.hand.id = 4;
    p.steps(300);
    p.move({0.6, 0.0, 0.0}, 15);
    if (!same) p.hand.id = 9;
    p.move({0.6, 0.0, 0.0}, 15);
    p.steps(40);
    EXPECT_EQ(p.count(GestureKind::kSwipe, GesturePhase::kDone), same ? 1 : 0);
  }
}

}  // namespace
}  // namespace dubsar::test
