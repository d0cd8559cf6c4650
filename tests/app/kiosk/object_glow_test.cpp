#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "app/kiosk/hand_cursors.h"

namespace dubsar::app {
namespace {

const CursorScene kStage{{{-0.35, -0.25, -0.2}, {0.35, 0.35, 0.6}}, {600, 340}, {0, 0}};
const std::vector<ScreenRect> kObject{{{-60, -80}, {60, 80}}};

HandMark hand(double x, double y, HandState state) { return {{x, y, 0.2}, 0.0, 0.0, state}; }

TEST(ObjectGlow, IsOnTheObjectOnTheSideOfTheNearestHandThatMayTakeIt) {
  const std::array right{hand(0.3, 0.05, HandState::kReady)};
  const Glow beside = object_glow(kStage, right, kObject);
  EXPECT_GT(beside.at_mm.x, 30.0);
  EXPECT_LE(beside.at_mm.x, 60.0);
  EXPECT_NEAR(beside.at_mm.y, 0.0, 1.0);
  EXPECT_GT(beside.strength, 0.2);
  const std::array before{hand(0.02, 0.07, HandState::kReady)};
  const Glow on = object_glow(kStage, before, kObject);
  EXPECT_NEAR(glm::distance(glm::dvec2(on.at_mm), glm::dvec2(cursor_place_mm(kStage, before[0].place_m))), 0.0, 1e-9);
  EXPECT_GT(on.strength, beside.strength) << "the nearer the hand, the brighter";
  const std::array both{hand(0.3, 0.05, HandState::kReady), hand(-0.1, 0.05, HandState::kReady)};
  EXPECT_LT(object_glow(kStage, both, kObject).at_mm.x, 0.0);
  const std::array holds{hand(0.3, 0.05, HandState::kHolding), hand(-0.1, 0.05, HandState::kReady)};
  EXPECT_GT(object_glow(kStage, holds, kObject).at_mm.x, 0.0) << "who holds it has it";
}

TEST(ObjectGlow, IsNotThereForHandsThatCouldNotTakeHold) {
  for (const HandState state : {HandState::kFist, HandState::kTooFar, HandState::kStranger}) {
    const std::array one{hand(0.0, 0.05, state)};
    EXPECT_EQ(object_glow(kStage, one, kObject).strength, 0.0);
  }
  EXPECT_EQ(object_glow(kStage, {}, kObject).strength, 0.0);
  const std::array ready{hand(0.0, 0.05, HandState::kReady)};
  EXPECT_EQ(object_glow(kStage, ready, {}).strength, 0.0) << "nothing to take";
}

TEST(ObjectGlow, OfTwoThatStandApartTheNearerOneGlows) {
  const std::vector<ScreenRect> apart{{{-40, 20}, {40, 120}}, {{-40, -120}, {40, -20}}};
  const std::array low{hand(0.1, -0.1, HandState::kReady)}, high{hand(0.1, 0.25, HandState::kReady)};
  EXPECT_LT(object_glow(kStage, low, apart).at_mm.y, -20.0);
  EXPECT_GT(object_glow(kStage, high, apart).at_mm.y, 20.0);
}

TEST(ObjectGlow, ComesGoesAndMovesOnWithoutAJumpOrAFlash) {
  EasedGlow eased;
  const Glow left{{-40, 0, 0}, 60.0, 0.9}, right{{40, 0, 0}, 60.0, 0.9};
  Glow before;
  double fastest = 0.0, widest = 0.0;
  for (int i = 0; i < 600; ++i) {  // a hand that is lost ten times a second, and comes back at the other side
    const int beat = i / 6;
    const Glow now = eased.update(beat % 2 == 0 ? (beat % 4 == 0 ? left : right) : Glow(), 1.0 / 60.0);
    fastest = std::max(fastest, std::abs(now.strength - before.strength));
    if (before.strength > 0.05) widest = std::max(widest, glm::distance(now.at_mm, before.at_mm));
    before = now;
  }
  EXPECT_LE(fastest, 1.0 / 60.0 / 0.3) << "of all its brightness, in a picture";
  EXPECT_LE(widest, 20.0) << "mm, in a picture";
}

}  // namespace
}  // namespace dubsar::app
