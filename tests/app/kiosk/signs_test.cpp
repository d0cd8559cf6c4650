#include "app/kiosk/signs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace dubsar::app {
namespace {

constexpr TimestampNs kStep = 50'000'000;
constexpr double kAspect = 16.0 / 9.0;

/// One hand before the signs of a panel.
struct Panel {
  std::vector<SignPicture> signs = place_signs(std::array{Sign::kOpen, Sign::kTour}, kAspect);
  SignRest rest;
  TimestampNs now = 0;
  std::vector<Sign> chosen;

  void go_on(double seconds, std::vector<SignHand> hands) {
    for (int i = 0; i < static_cast<int>(20 * seconds); ++i) {
      now += kStep;
      if (const auto sign = rest.update(now, hands, signs, kAspect)) chosen.push_back(*sign);
    }
  }
};

TEST(Signs, StandApartWithinThePanelAndCanBeHitByAHandThatTrembles) {
  for (const double aspect : {0.5625, 0.75, 1.0, 1.78, 2.4}) {
    const auto signs = place_signs(std::array{Sign::kOpen, Sign::kClose, Sign::kTour}, aspect);
    for (const SignPicture& sign : signs) {
      EXPECT_LE(std::abs(sign.at.x) * aspect + sign.radius, 0.5 * aspect) << aspect;
      EXPECT_LE(std::abs(sign.at.y) + sign.radius, 0.5) << aspect;
      EXPECT_GE(sign.radius, 0.07) << aspect;  // a trembling hand's ring moves by a hundredth of the height
    }
    for (std::size_t i = 1; i < signs.size(); ++i)
      EXPECT_GT(signs[i - 1].at.y - signs[i].at.y, 2.0 * signs[i].radius) << aspect;
  }
}

TEST(Signs, ARestChoosesOnceAndNothingElseUntilTheHandHasLeft) {
  Panel panel;
  const SignHand on{panel.signs[0].at}, off{{0.0, 0.0}};
  panel.go_on(1.0, {on});
  EXPECT_TRUE(panel.chosen.empty());
  EXPECT_GT(panel.rest.filled(Sign::kOpen), 0.3);
  panel.go_on(1.4, {on});
  ASSERT_EQ(panel.chosen.size(), 1U);
  EXPECT_EQ(panel.chosen[0], Sign::kOpen);
  panel.go_on(20.0, {on});
  panel.go_on(3.0, {SignHand{panel.signs[1].at}});  // from one sign to the next without leaving
  EXPECT_EQ(panel.chosen.size(), 1U);
  panel.go_on(0.2, {off});
  panel.go_on(2.5, {SignHand{panel.signs[1].at}});
  ASSERT_EQ(panel.chosen.size(), 2U);
  EXPECT_EQ(panel.chosen[1], Sign::kTour);
}

TEST(Signs, WhatEndsThereByChanceChoosesNothing) {
  Panel panel;
  const SignHand on{panel.signs[0].at}, holds{panel.signs[0].at, false};
  panel.go_on(1.0, {holds});  // it carried the object here, and lets go
  panel.go_on(5.0, {on});
  EXPECT_TRUE(panel.chosen.empty());
  for (int i = 0; i < 20; ++i) {  // it passes again and again
    panel.go_on(0.6, {SignHand{{0.0, 0.0}}});
    panel.go_on(1.4, {on});
  }
  EXPECT_TRUE(panel.chosen.empty());
  panel.go_on(0.5, {SignHand{{0.0, 0.0}}});
  panel.go_on(2.0, {on});  // where a movement ended, until the next one begins
  EXPECT_TRUE(panel.chosen.empty());
}

TEST(Signs, AHandThatSinksFromAChosenSignToTheNextChoosesNothing) {
  Panel panel;
  panel.go_on(2.5, {SignHand{panel.signs[0].at}});
  ASSERT_EQ(panel.chosen.size(), 1U);
  const auto there = std::exchange(panel.signs, {});  // while the envelope moves there are none
  panel.go_on(2.5, {SignHand{there[0].at - glm::dvec2(0.0, 0.1)}});
  panel.signs = there;
  panel.go_on(10.0, {SignHand{there[1].at}});
  EXPECT_EQ(panel.chosen.size(), 1U);
  panel.go_on(0.2, {SignHand{{0.1, 0.0}}});
  panel.go_on(2.5, {SignHand{there[1].at}});
  EXPECT_EQ(panel.chosen.size(), 2U);
}

TEST(Signs, ATrembleOverTheEdgeAndAHandThatIsLostForAMomentBreakNoRest) {
  Panel panel;
  const double edge = panel.signs[0].radius / kAspect;
  for (int i = 0; i < 60 && panel.chosen.empty(); ++i) {
    const SignHand on{panel.signs[0].at + glm::dvec2((0.95 + 0.1 * (i % 2)) * -edge, 0.0)};
    panel.go_on(0.05, i % 10 == 3 ? std::vector<SignHand>{} : std::vector{on});
  }
  EXPECT_EQ(panel.chosen.size(), 1U);
}

}  // namespace
}  // namespace dubsar::app
