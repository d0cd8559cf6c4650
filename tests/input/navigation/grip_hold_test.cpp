// The object in the hand: exact rigid motion, two hands, and hands that become controllers in the middle of a hold.

#include "input/navigation/grip_hold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace dubsar {
namespace {

constexpr double kLeast = 0.1, kMost = 10.0;

HandGrip closed_at(const glm::dvec3& at, const glm::dquat& turn = {1, 0, 0, 0}) {
  return {true, true, true, {at, turn}};
}
HandGrip open_at(const glm::dvec3& at) { return {true, false, true, {at, {1, 0, 0, 0}}}; }

/// A mark of the object in the room: what is painted on it at `local`.
glm::dvec3 mark(const HeldObject& object, const glm::dvec3& local) {
  return object.centre_m + object.scale * (object.rotation * local);
}

TEST(GripHold, WhatIsHeldIsRigidWithTheHandInSixDegrees) {
  HeldObject object{{0.1, -0.05, 0.02}, glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 2, 3))), 1.0, 0.05};
  GripHold hold;
  const glm::dquat begin = glm::angleAxis(1.1, glm::normalize(glm::dvec3(0, 1, 1)));
  const glm::dvec3 hand(0.15, -0.02, 0.05);
  EXPECT_TRUE(hold.follow({HandGrip{}, closed_at(hand, begin)}, object, kLeast, kMost));
  const glm::dvec3 in_hand = glm::conjugate(begin) * (mark(object, {0.02, 0.03, -0.01}) - hand);
  for (int i = 1; i <= 40; ++i) {
    const glm::dquat turn = glm::angleAxis(0.13 * i, glm::normalize(glm::dvec3(3, -1, 0.1 * i))) * begin;
    const glm::dvec3 at = hand + 0.01 * i * glm::dvec3(0.3, -0.2, 0.5);
    EXPECT_FALSE(hold.follow({HandGrip{}, closed_at(at, turn)}, object, kLeast, kMost));
    EXPECT_LE(glm::distance(mark(object, {0.02, 0.03, -0.01}), at + turn * in_hand), 1e-12) << i;
  }
  const HeldObject left = object;
  hold.follow({HandGrip{}, open_at({5, 5, 5})}, object, kLeast, kMost);
  EXPECT_FALSE(hold.holds());
  hold.follow({HandGrip{}, open_at({-5, 5, 5})}, object, kLeast, kMost);
  EXPECT_EQ(object.centre_m, left.centre_m) << "it stays where it was let go";
}

TEST(GripHold, OnlyWhatClosesWithinReachTakesHold) {
  HeldObject object;
  GripHold hold;
  EXPECT_FALSE(hold.follow({closed_at({0.2, 0, 0}), HandGrip{}}, object, kLeast, kMost)) << "15 cm from its surface";
  EXPECT_FALSE(hold.follow({closed_at({0.05, 0, 0}), HandGrip{}}, object, kLeast, kMost)) << "a fist that comes near";
  EXPECT_FALSE(hold.follow({open_at({0.05, 0, 0}), HandGrip{}}, object, kLeast, kMost));
  EXPECT_TRUE(hold.follow({closed_at({0.1, 0, 0}), HandGrip{}}, object, kLeast, kMost));
  EXPECT_FALSE(hold.follow({HandGrip{}, HandGrip{}}, object, kLeast, kMost));
  EXPECT_FALSE(hold.holds()) << "a hand that is not seen holds nothing";
}

TEST(GripHold, TwoHandsScaleAboutTheMiddleBetweenThem) {
  HeldObject object{{0.0, 0.0, 0.0}, {1, 0, 0, 0}, 1.0, 0.05};
  GripHold hold;
  hold.follow({closed_at({-0.05, 0, 0}), open_at({0.3, 0, 0})}, object, kLeast, kMost);
  EXPECT_TRUE(hold.follow({closed_at({-0.05, 0, 0}), closed_at({0.15, 0, 0})}, object, kLeast, kMost))
      << "from anywhere";
  // Twice as far apart, a quarter turn about z: the middle (0.05, 0, 0) stays, the centre goes from -x of it to -y.
  hold.follow({closed_at({0.05, -0.2, 0}), closed_at({0.05, 0.2, 0})}, object, kLeast, kMost);
  EXPECT_NEAR(object.scale, 2.0, 1e-12);
  EXPECT_LE(glm::distance(object.centre_m, glm::dvec3(0.05, -0.1, 0)), 1e-12);
  EXPECT_LE(glm::distance(object.rotation * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)), 1e-9);
  // One lets go: the other goes on from here without a jump.
  const HeldObject before = object;
  hold.follow({closed_at({0.05, -0.2, 0}), open_at({0.05, 0.2, 0})}, object, kLeast, kMost);
  EXPECT_LE(glm::distance(object.centre_m, before.centre_m), 1e-12);
  hold.follow({closed_at({0.06, -0.2, 0}), open_at({0.05, 0.2, 0})}, object, kLeast, kMost);
  EXPECT_NEAR(object.centre_m.x, before.centre_m.x + 0.01, 1e-12);
  EXPECT_EQ(object.scale, before.scale);
}

TEST(GripHold, AHandThatBecomesAControllerMovesNothing) {
  HeldObject object;
  GripHold hold;
  HandGrip bare = closed_at({0.05, 0, 0});
  bare.controller = false;
  hold.follow({HandGrip{}, bare}, object, kLeast, kMost);
  const HeldObject before = object;
  const glm::dquat other = glm::angleAxis(0.7, glm::dvec3(1, 0, 0));  // its grip is somewhere else in the same hand
  hold.follow({HandGrip{}, closed_at({0.02, -0.03, 0.04}, other)}, object, kLeast, kMost);
  EXPECT_LE(glm::distance(object.centre_m, before.centre_m), 1e-12);
  EXPECT_TRUE(hold.holds());
  hold.follow({HandGrip{}, closed_at({0.02, 0.07, 0.04}, other)}, object, kLeast, kMost);
  EXPECT_NEAR(object.centre_m.y, before.centre_m.y + 0.1, 1e-12);
}

}  // namespace
}  // namespace dubsar
