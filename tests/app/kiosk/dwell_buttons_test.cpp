#include "app/kiosk/dwell_buttons.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

namespace dubsar::app {
namespace {

constexpr TimestampNs kDwellStep = 50'000'000;
constexpr double kAspect = 16.0 / 9.0;

/// One hand before the buttons of a panel.
struct Panel {
  std::vector<DwellButtonPicture> buttons = place_buttons(std::array{DwellButton::kOpen, DwellButton::kTour}, kAspect);
  DwellTimer rest;
  TimestampNs now = 0;
  std::vector<DwellButton> chosen;

  void go_on(double seconds, std::vector<DwellHand> hands) {
    for (int i = 0; i < static_cast<int>(20 * seconds); ++i) {
      now += kDwellStep;
      if (const auto button = rest.update(now, hands, buttons, kAspect)) chosen.push_back(*button);
    }
  }
};

TEST(DwellButtons, StandApartWithinThePanelAndCanBeHitByAHandThatTrembles) {
  for (const double aspect : {0.5625, 0.75, 1.0, 1.78, 2.4}) {
    const auto buttons = place_buttons(std::array{DwellButton::kOpen, DwellButton::kClose, DwellButton::kTour}, aspect);
    for (const DwellButtonPicture& button : buttons) {
      EXPECT_LE(std::abs(button.at.x) * aspect + button.radius, 0.5 * aspect) << aspect;
      EXPECT_LE(std::abs(button.at.y) + button.radius, 0.5) << aspect;
      EXPECT_GE(button.radius, 0.07) << aspect;  // a trembling hand's ring moves by a hundredth of the height
    }
    for (std::size_t i = 1; i < buttons.size(); ++i)
      EXPECT_GT(glm::length(glm::dvec2(aspect, 1.0) * (buttons[i - 1].at - buttons[i].at)), 2.0 * buttons[i].radius)
          << aspect;
  }
}

/// The object is at most as high and wide as what gallery_room() leaves, in the panel's middle.
TEST(DwellButtons, StandBesideTheObjectOnEveryShapeOfPanel) {
  constexpr double kMargin = 0.08;  // of the stage, where neither words nor buttons need more
  for (const double aspect : {0.5, 0.5625, 0.75, 0.99, 1.0, 1.25, 1.6, 1.78, 2.4}) {
    const GalleryRoom room = gallery_room(aspect);
    const double half = std::min((0.5 - std::max(kMargin, room.sides)) * aspect, 0.5 - std::max(kMargin, room.words));
    EXPECT_GT(half, 0.12) << aspect;
    for (const DwellButtonPicture& button :
         place_buttons(std::array{DwellButton::kOpen, DwellButton::kTour, DwellButton::kLeave}, aspect)) {
      const glm::dvec2 at(button.at.x * aspect, button.at.y);
      const glm::dvec2 nearest = glm::clamp(at, glm::dvec2(-half), glm::dvec2(half));
      EXPECT_GT(glm::length(at - nearest), button.radius) << aspect;
    }
  }
}

TEST(DwellButtons, ARestChoosesOnceAndNothingElseUntilTheHandHasLeft) {
  Panel panel;
  const DwellHand on{panel.buttons[0].at}, off{{0.0, 0.0}};
  panel.go_on(1.0, {on});
  EXPECT_TRUE(panel.chosen.empty());
  EXPECT_GT(panel.rest.filled(DwellButton::kOpen), 0.3);
  panel.go_on(1.4, {on});
  ASSERT_EQ(panel.chosen.size(), 1U);
  EXPECT_EQ(panel.chosen[0], DwellButton::kOpen);
  panel.go_on(20.0, {on});
  panel.go_on(3.0, {DwellHand{panel.buttons[1].at}});  // from one button to the next without leaving
  EXPECT_EQ(panel.chosen.size(), 1U);
  panel.go_on(0.2, {off});
  panel.go_on(2.5, {DwellHand{panel.buttons[1].at}});
  ASSERT_EQ(panel.chosen.size(), 2U);
  EXPECT_EQ(panel.chosen[1], DwellButton::kTour);
}

TEST(DwellButtons, WhatEndsThereByChanceChoosesNothing) {
  Panel panel;
  const DwellHand on{panel.buttons[0].at}, holds{panel.buttons[0].at, false};
  panel.go_on(1.0, {holds});  // it carried the object here, and lets go
  panel.go_on(5.0, {on});
  EXPECT_TRUE(panel.chosen.empty());
  for (int i = 0; i < 20; ++i) {  // it passes again and again
    panel.go_on(0.6, {DwellHand{{0.0, 0.0}}});
    panel.go_on(1.4, {on});
  }
  EXPECT_TRUE(panel.chosen.empty());
  panel.go_on(0.5, {DwellHand{{0.0, 0.0}}});
  panel.go_on(2.0, {on});  // where a movement ended, until the next one begins
  EXPECT_TRUE(panel.chosen.empty());
}

TEST(DwellButtons, AHandThatSinksFromAChosenSignToTheNextChoosesNothing) {
  Panel panel;
  panel.go_on(2.5, {DwellHand{panel.buttons[0].at}});
  ASSERT_EQ(panel.chosen.size(), 1U);
  const auto there = std::exchange(panel.buttons, {});  // while the envelope moves there are none
  panel.go_on(2.5, {DwellHand{there[0].at - glm::dvec2(0.0, 0.1)}});
  panel.buttons = there;
  panel.go_on(10.0, {DwellHand{there[1].at}});
  EXPECT_EQ(panel.chosen.size(), 1U);
  panel.go_on(0.2, {DwellHand{{0.1, 0.0}}});
  panel.go_on(2.5, {DwellHand{there[1].at}});
  EXPECT_EQ(panel.chosen.size(), 2U);
}

TEST(DwellButtons, ATrembleOverTheEdgeAndAHandThatIsLostForAMomentBreakNoRest) {
  Panel panel;
  const double edge = panel.buttons[0].radius / kAspect;
  for (int i = 0; i < 60 && panel.chosen.empty(); ++i) {
    const DwellHand on{panel.buttons[0].at + glm::dvec2((0.95 + 0.1 * (i % 2)) * -edge, 0.0)};
    panel.go_on(0.05, i % 10 == 3 ? std::vector<DwellHand>{} : std::vector{on});
  }
  EXPECT_EQ(panel.chosen.size(), 1U);
}

}  // namespace
}  // namespace dubsar::app
