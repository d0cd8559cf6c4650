#include "input/people/person_keeper.h"

#include <gtest/gtest.h>

#include "tests/input/milliseconds.h"

namespace dubsar {
namespace {

using test::kMs;

HandFrame hand_at(std::uint32_t id, Chirality side, const glm::dvec3& at_m) {
  HandFrame hand;
  hand.id = id;
  hand.chirality = side;
  hand.valid = hand.tracked = true;
  hand.palm.position_m = at_m;
  return hand;
}

HeadFrame head_before(std::uint32_t id, const glm::dvec3& at_m) {
  HeadFrame head;
  head.id = id;
  head.tracked = true;
  head.left_eye_m = at_m - glm::dvec3(0.03, 0, 0);
  head.right_eye_m = at_m + glm::dvec3(0.03, 0, 0);
  return head;
}

TEST(HeadKeeper, TakesTheNearestAndMostCentralAndKeepsItWhenSomebodyComesNearer) {
  HeadKeeper keeper;
  std::vector<HeadFrame> heads{head_before(1, {0.5, 0, 0.6}), head_before(2, {0.05, 0, 0.7})};
  ASSERT_NE(keeper.update(0, heads), nullptr);
  EXPECT_EQ(keeper.update(16 * kMs, heads)->id, 2u);
  heads.push_back(head_before(3, {0.0, 0, 0.3}));
  EXPECT_EQ(keeper.update(32 * kMs, heads)->id, 2u);
}

TEST(HeadKeeper, KnowsAHeadAgainByItsPlaceAndLetsAnotherInAfterASecond) {
  HeadKeeper keeper;
  const std::vector<HeadFrame> first{head_before(1, {0.1, 0, 0.6})};
  ASSERT_NE(keeper.update(0, first), nullptr);
  const std::vector<HeadFrame> renamed{head_before(7, {0.15, 0, 0.6}), head_before(8, {-0.4, 0, 0.5})};
  EXPECT_EQ(keeper.update(100 * kMs, renamed)->id, 7u);
  const std::vector<HeadFrame> other{head_before(8, {-0.4, 0, 0.5})};
  EXPECT_EQ(keeper.update(900 * kMs, other), nullptr);
  ASSERT_NE(keeper.update(1200 * kMs, other), nullptr);
  EXPECT_EQ(keeper.update(1216 * kMs, other)->id, 8u);
}

TEST(HeadKeeper, WhoLookedOnFromBesideMakesRoomForWhoStandsBeforeThePanel) {
  const HeadFrame beside = head_before(1, {0.5, 0, 0.6}), before = head_before(2, {0.0, 0, 0.7});
  for (const bool rests : {true, false}) {
    HeadKeeper keeper;
    const std::vector<HeadFrame> alone{beside}, both{beside, before};
    ASSERT_EQ(keeper.update(0, alone, rests)->id, 1u);
    EXPECT_EQ(keeper.update(100 * kMs, both, rests)->id, 1u);
    EXPECT_EQ(keeper.update(580 * kMs, both, rests)->id, 1u);
    EXPECT_EQ(keeper.update(620 * kMs, both, rests)->id, rests ? 2u : 1u);
    EXPECT_EQ(keeper.update(1120 * kMs, both, rests)->id, 2u);
  }
}

TEST(HandKeeper, AHandWhoseShoulderIsOnTheWrongSideOfTheHeadIsSomebodyElses) {
  // straight hands: the shoulder is behind them
  for (const auto& [x, in] :
       {std::pair{0.1, true}, std::pair{-0.02, true}, std::pair{-0.15, false}, std::pair{0.34, false}}) {
    HandKeeper keeper;
    const std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {x, 0, 0.3})};
    std::vector<HeadFrame> heads{head_before(1, {0.0, 0, 0.7})};
    if (!in) heads.push_back(head_before(2, {x < 0 ? -0.4 : 0.6, 0, 0.7}));  // else the tracker may have mistaken it
    EXPECT_EQ(keeper.update(0, hands, heads, glm::dvec3(0.0, 0.0, 0.7))[0] != nullptr, in) << x;
  }
}

TEST(HandKeeper, ARightHandStaysAloneNextToAnotherRightHand) {
  HandKeeper keeper;
  std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {0.1, 0, 0.3})};
  ASSERT_EQ(keeper.update(0, hands, {}, {})[0]->id, 1u);
  hands.insert(hands.begin(), hand_at(2, Chirality::kRight, {0.0, 0, 0.2}));
  const auto kept = keeper.update(16 * kMs, hands, {}, {});
  EXPECT_EQ(kept[0]->id, 1u);
  EXPECT_EQ(kept[1], nullptr);
}

TEST(HandKeeper, TheOtherHandOfAPairIsLetInButNotACrossedFarOrDeepOne) {
  struct Case {
    glm::dvec3 at;
    bool in;
  };
  for (const Case& c : {Case{{-0.1, 0, 0.3}, true},
                        {{0.3, 0, 0.3}, false},
                        {{-0.5, 0, 0.3}, false},
                        {{-0.1, 0, 0.75}, false},
                        {{0.08, 0, 0.3}, false}}) {
    HandKeeper keeper({{-1, -1, -1}, {1, 1, 1}});
    std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {0.1, 0, 0.3})};
    (void)keeper.update(0, hands, {}, {});
    hands.push_back(hand_at(2, Chirality::kLeft, c.at));
    EXPECT_EQ(keeper.update(16 * kMs, hands, {}, {})[1] != nullptr, c.in) << c.at.x << " " << c.at.z;
  }
}

TEST(HandKeeper, AHandMustComeInThroughTheZoneAndMayThenLeaveIt) {
  HandKeeper keeper({{-0.2, -0.2, 0}, {0.2, 0.2, 0.4}});
  std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {0.3, 0, 0.3})};
  EXPECT_EQ(keeper.update(0, hands, {}, {})[0], nullptr);
  hands[0].palm.position_m.x = 0.1;
  EXPECT_NE(keeper.update(16 * kMs, hands, {}, {})[0], nullptr);
  hands[0].palm.position_m.x = 0.3;
  EXPECT_NE(keeper.update(32 * kMs, hands, {}, {})[0], nullptr);
}

TEST(HandKeeper, AHandThatReachesInFromTheSideIsIgnored) {
  HandKeeper keeper;
  HandFrame hand = hand_at(1, Chirality::kLeft, {0.1, 0, 0.3});
  hand.palm.rotation = glm::angleAxis(1.3, glm::dvec3(0, 1, 0));  // fingers point to the left
  EXPECT_EQ(keeper.update(0, std::vector{hand}, {}, {})[0], nullptr);
}

TEST(HandKeeper, AHandWhoseArmComesFromAnotherHeadIsIgnored) {
  const std::vector<HeadFrame> heads{head_before(1, {0, 0, 0.6}), head_before(2, {0.4, 0, 0.6})};
  const std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {0.3, 0, 0.4})};
  HandKeeper with_heads, without;
  EXPECT_EQ(with_heads.update(0, hands, heads, glm::dvec3(0, 0, 0.6))[0], nullptr);
  EXPECT_NE(without.update(0, hands, {}, {})[0], nullptr);
}

TEST(HandKeeper, ANewTrackerIdAtTheSamePlaceIsTheSameHand) {
  HandKeeper keeper;
  std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {0.1, 0, 0.3})};
  (void)keeper.update(0, hands, {}, {});
  EXPECT_EQ(keeper.update(100 * kMs, {}, {}, {})[0], nullptr);
  hands = {hand_at(5, Chirality::kRight, {-0.2, 0, 0.3}), hand_at(6, Chirality::kRight, {0.15, 0, 0.3})};
  EXPECT_EQ(keeper.update(200 * kMs, hands, {}, {})[0]->id, 6u);
}

TEST(HandKeeper, AHandThatAppearsTooFarAwayTooSoonIsSomebodyElses) {
  const std::vector<HandFrame> mine{hand_at(1, Chirality::kRight, {0.1, 0, 0.3})};
  const std::vector<HandFrame> found{hand_at(2, Chirality::kRight, {0.17, 0, 0.3})};
  HandKeeper keeper, later;
  (void)keeper.update(0, mine, {}, {});
  (void)later.update(0, mine, {}, {});
  EXPECT_EQ(keeper.update(100 * kMs, found, {}, {})[0], nullptr);
  EXPECT_NE(later.update(300 * kMs, found, {}, {})[0], nullptr);
}

TEST(HandKeeper, WithoutACameraThoseWhoStandBesideHoldNothing) {
  HandKeeper keeper;
  // A right hand in the middle of the zone, of an arm that comes from far to the left.
  HandFrame beside = hand_at(1, Chirality::kRight, {-0.1, 0.0, 0.3});
  beside.palm.rotation = glm::angleAxis(-0.4, glm::dvec3(0, 1, 0));
  const std::vector<HandFrame> hands{beside};
  for (int i = 0; i < 50; ++i) EXPECT_EQ(keeper.update(i * 16 * kMs, hands, {}, {})[0], nullptr);
  const std::vector<HandFrame> both{beside, hand_at(2, Chirality::kRight, {0.15, 0.0, 0.3})};
  const auto kept = keeper.update(900 * kMs, both, {}, {});
  ASSERT_NE(kept[0], nullptr);
  EXPECT_EQ(kept[0]->id, 2u);
}

TEST(HandKeeper, AHandThatTheTrackerTakesForTheOtherOneIsLetInWhereNobodyElseThereCouldHaveIt) {
  const std::vector<HandFrame> called_left{hand_at(1, Chirality::kLeft, {0.15, 0.0, 0.3})};
  const std::vector<HeadFrame> alone{head_before(1, {0.0, 0.0, 0.7})};
  const std::vector<HeadFrame> two{head_before(1, {0.0, 0.0, 0.7}), head_before(2, {0.4, 0.0, 0.7})};
  HandKeeper keeper, in_a_crowd, without_a_camera;
  EXPECT_NE(keeper.update(0, called_left, alone, glm::dvec3(0.0, 0.0, 0.7))[0], nullptr);
  EXPECT_EQ(in_a_crowd.update(0, called_left, two, glm::dvec3(0.0, 0.0, 0.7))[0], nullptr) << "the other's left hand";
  EXPECT_EQ(without_a_camera.update(0, called_left, {}, {})[0], nullptr) << "of somebody beside, as far as one knows";
}

TEST(HandKeeper, WithoutACameraWhoStandsBeforeTheMiddleTakesThePlaceOfOneWhoReachesInFromBeside) {
  const HandFrame beside = hand_at(1, Chirality::kLeft, {0.09, 0.0, 0.3});  // of a body at 0.28
  const HandFrame before = hand_at(2, Chirality::kRight, {0.2, 0.0, 0.3});
  const std::vector<HandFrame> first{beside}, both{beside, before};
  HandKeeper keeper;
  TimestampNs now = 0;
  for (; now < 1000 * kMs; now += 16 * kMs) ASSERT_NE(keeper.update(now, first, {}, {})[0], nullptr);
  for (const TimestampNs came = now; now - came < 480 * kMs; now += 16 * kMs)
    ASSERT_EQ(keeper.update(now, both, {}, {})[0]->id, 1U);
  for (int i = 0; i < 4; ++i) (void)keeper.update(now += 16 * kMs, both, {}, {});
  const auto kept = keeper.update(now += 16 * kMs, both, {}, {});
  ASSERT_NE(kept[0], nullptr);
  EXPECT_EQ(kept[0]->id, 2U);
  EXPECT_EQ(kept[1], nullptr);
}

TEST(HandKeeper, WithoutACameraWhoStandsAlmostBeforeTheMiddleStaysTheOwner) {
  const std::vector<HandFrame> both{hand_at(1, Chirality::kRight, {0.3, 0.0, 0.3}),  // of bodies at 0.11 and 0.01
                                    hand_at(2, Chirality::kRight, {0.2, 0.0, 0.3})};
  HandKeeper keeper;
  (void)keeper.update(0, std::vector{both[0]}, {}, {});
  for (TimestampNs now = 16 * kMs; now < 3000 * kMs; now += 16 * kMs)
    ASSERT_EQ(keeper.update(now, both, {}, {})[0]->id, 1U);
}

TEST(HandKeeper, TheOwnerMayLetTheHandSinkForAWhileAndNobodyElseTakesOver) {
  HandKeeper keeper;
  const std::vector<HandFrame> owner{hand_at(1, Chirality::kRight, {0.35, 0.0, 0.3})};
  const std::vector<HandFrame> other{hand_at(7, Chirality::kRight, {0.0, 0.0, 0.3})};
  for (int i = 0; i < 60; ++i) ASSERT_NE(keeper.update(i * 16 * kMs, owner, {}, {})[0], nullptr);
  EXPECT_EQ(keeper.update(3500 * kMs, other, {}, {})[0], nullptr);
  const std::vector<HandFrame> again{hand_at(3, Chirality::kRight, {0.3, 0.1, 0.3})};
  EXPECT_NE(keeper.update(3600 * kMs, again, {}, {})[0], nullptr);
  EXPECT_NE(keeper.update(9000 * kMs, other, {}, {})[0], nullptr) << "the owner is gone";
}

TEST(HandKeeper, AKeptHandThatTurnsOutToBeAnotherHeadsIsLetGoAfterAWhile) {
  HandKeeper keeper;
  const std::optional<glm::dvec3> kept_head(glm::dvec3(0.0, 0.0, 0.7));
  std::vector<HeadFrame> heads{head_before(1, *kept_head)};
  const std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {0.3, 0, 0.3})};
  ASSERT_NE(keeper.update(0, hands, heads, kept_head)[0], nullptr) << "nobody else is seen";
  heads.push_back(head_before(2, {0.48, 0, 0.7}));  // the body of the hand that comes stands at 0.43 m
  const std::vector<HandFrame> moved{hand_at(1, Chirality::kRight, {0.62, 0, 0.3})};
  EXPECT_NE(keeper.update(100 * kMs, moved, heads, kept_head)[0], nullptr) << "it may be noise";
  EXPECT_NE(keeper.update(300 * kMs, moved, heads, kept_head)[0], nullptr);
  EXPECT_EQ(keeper.update(420 * kMs, moved, heads, kept_head)[0], nullptr);
}

TEST(HandKeeper, ItIsSureWhoseHandItIsByHeadsByTheArmOrAfterAWhile) {
  const std::vector<HandFrame> straight{hand_at(1, Chirality::kRight, {0.19, 0, 0.3})};
  const std::vector<HandFrame> aslant{hand_at(1, Chirality::kRight, {0.38, 0, 0.3})};
  HandZone wide;
  wide.max_m.x = 0.5;
  HandKeeper alone(wide), beside(wide), watched(wide), crowded(wide);
  ASSERT_NE(alone.update(0, straight, {}, {})[0], nullptr);
  EXPECT_TRUE(alone.standing()[0].sure) << "squarely before the middle";
  ASSERT_NE(beside.update(0, aslant, {}, {})[0], nullptr);
  EXPECT_FALSE(beside.standing()[0].sure);
  for (int i = 1; i <= 40; ++i) beside.update(i * 100 * kMs, aslant, {}, {});
  EXPECT_TRUE(beside.standing()[0].sure) << "followed for four seconds";
  const glm::dvec3 kept_head(0.1, 0.0, 0.7);
  std::vector<HeadFrame> heads{head_before(1, kept_head)};
  ASSERT_NE(watched.update(0, straight, heads, kept_head)[0], nullptr);
  EXPECT_TRUE(watched.standing()[0].sure) << "nobody else is there";
  heads.push_back(head_before(2, {-0.22, 0, 0.75}));
  ASSERT_NE(crowded.update(0, straight, heads, kept_head)[0], nullptr);
  EXPECT_FALSE(crowded.standing()[0].sure) << "another head is as near to that arm";
}

TEST(HandKeeper, ALeftHandThatMayBeTheRightHandOfSomebodyBesideIsNotSure) {
  const glm::dvec3 kept_head(0.0, 0.0, 0.7);
  std::vector<HeadFrame> heads{head_before(1, kept_head)};
  const std::vector<HandFrame> called_left{hand_at(1, Chirality::kLeft, {-0.19, 0.0, 0.3})};
  HandKeeper alone, beside, far;
  ASSERT_NE(alone.update(0, called_left, heads, kept_head)[0], nullptr);
  EXPECT_TRUE(alone.standing()[0].sure);
  heads.push_back(head_before(2, {-0.4, 0.0, 0.75}));  // whose right shoulder is where the kept head's left one is
  ASSERT_NE(beside.update(0, called_left, heads, kept_head)[0], nullptr);
  EXPECT_FALSE(beside.standing()[0].sure);
  heads[1] = head_before(2, {0.4, 0.0, 0.75});
  ASSERT_NE(far.update(0, called_left, heads, kept_head)[0], nullptr);
  EXPECT_TRUE(far.standing()[0].sure) << "neither shoulder of the other one is there";
}

TEST(HandKeeper, WhereNoHeadIsSeenHandsTellWhoIsBeside) {
  const HandFrame called_left = hand_at(1, Chirality::kLeft, {-0.19, 0.0, 0.3});
  const HandFrame beside = hand_at(2, Chirality::kRight, {-0.2, 0.1, 0.3});  // of a body at -0.39
  HandKeeper alone, crowded;
  ASSERT_NE(alone.update(0, std::vector{called_left}, {}, {})[0], nullptr);
  EXPECT_FALSE(alone.standing()[0].doubtful);
  TimestampNs now = 0;
  for (; now < 600 * kMs; now += 16 * kMs)
    ASSERT_EQ(crowded.update(now, std::vector{beside}, {}, {})[0], nullptr) << "he stands beside";
  ASSERT_NE(crowded.update(now, std::vector{called_left}, {}, {})[0], nullptr);
  EXPECT_TRUE(crowded.standing()[0].doubtful) << "the same arm, mistaken";
}

TEST(HandKeeper, AHandAtTheChinIsAtTheFace) {
  const glm::dvec3 kept_head(0.0, 0.1, 0.6);
  const std::vector<HeadFrame> heads{head_before(1, kept_head)};
  for (const bool at_chin : {true, false}) {
    HandKeeper keeper;
    const std::vector<HandFrame> hands{hand_at(1, Chirality::kRight, {0.1, at_chin ? 0.0 : -0.1, at_chin ? 0.5 : 0.4})};
    ASSERT_NE(keeper.update(0, hands, heads, kept_head)[0], nullptr);
    EXPECT_EQ(keeper.standing()[0].at_face, at_chin);
  }
}

}  // namespace
}  // namespace dubsar
