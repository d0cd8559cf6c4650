#include "app/kiosk/visit.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <vector>

#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kPicture = 50'000'000;  // 20 pictures a second

/// A visit told by what happens for how long.
class Story {
 public:
  explicit Story(const VisitFigures& figures = {}) : visit_(figures) {}
  /// Goes on for `seconds`; `seen` is called for each picture.
  VisitPicture go_on(double seconds, VisitMoment moment, const std::function<void(const VisitPicture&)>& seen = {}) {
    VisitPicture last;
    for (int i = 0; i < static_cast<int>(seconds * 20); ++i, now_ += kPicture) {
      last = visit_.update(now_, moment);
      resets += last.reset;
      arrivals += last.arrived;
      if (seen) seen(last);
    }
    return last;
  }
  const Visit& visit() const { return visit_; }
  int resets = 0, arrivals = 0;

 private:
  Visit visit_;
  TimestampNs now_ = 7'000'000'000;
};

VisitMoment nobody() { return {}; }
VisitMoment hand(HandState state, double turned_deg = 0.0) {
  VisitMoment out;
  out.hands = 1;
  out.hand = state;
  out.turned_deg = turned_deg;
  out.can_open = true;
  return out;
}

TEST(Visit, NobodyIsInvited) {
  Story story;
  const auto picture = story.go_on(5, nobody());
  EXPECT_EQ(picture.phase, VisitPhase::kAttract);
  EXPECT_EQ(picture.line, Line::kInvite);
  EXPECT_EQ(picture.tutorial, Tutorial::kGrab);  // a hand that reaches out
  EXPECT_EQ(story.arrivals, 0);
}

TEST(Visit, TeachesTheNextThingWhenOneSucceeded) {
  Story story;
  story.go_on(2, nobody());
  auto picture = story.go_on(1, hand(HandState::kReady));
  EXPECT_EQ(story.arrivals, 1);
  EXPECT_EQ(picture.tutorial, Tutorial::kGrab);
  picture = story.go_on(2.5, hand(HandState::kHolding));
  EXPECT_EQ(picture.tutorial, Tutorial::kTurn);
  story.go_on(1, hand(HandState::kHolding, 2.0));  // 40 degrees
  picture = story.go_on(3, hand(HandState::kReady));
  EXPECT_EQ(picture.phase, VisitPhase::kFree);
  EXPECT_EQ(picture.tutorial, Tutorial::kRest);
  EXPECT_EQ(picture.line, Line::kRest);
  EXPECT_EQ(story.visit().counts().done[static_cast<std::size_t>(Tutorial::kTurn)], 1);
}

TEST(Visit, LeavesThoseAloneWhoCan) {
  Story story;
  story.go_on(2, nobody());
  bool taught_turn = false, interrupted = false;
  story.go_on(0.2, hand(HandState::kReady));
  story.go_on(1.0, hand(HandState::kHolding, 2.0),
              [&](const VisitPicture& p) { taught_turn |= p.tutorial == Tutorial::kTurn; });
  story.go_on(30, hand(HandState::kHolding, 0.5),
              [&](const VisitPicture& p) { interrupted |= p.tutorial.has_value(); });
  EXPECT_FALSE(taught_turn);
  EXPECT_FALSE(interrupted);
}

TEST(Visit, ATutorialThatDoesNotHelpRestsAndIsGivenUp) {
  Story story;
  int shown = 0;
  bool was = false;
  story.go_on(120, hand(HandState::kReady), [&](const VisitPicture& p) {
    const bool is = p.tutorial == Tutorial::kGrab;
    shown += is && !was;
    was = is;
  });
  EXPECT_EQ(shown, 6);
}

TEST(Visit, WhoseHandIsNotSeenLearnsHowItIsAfterHowToTakeHold) {
  Story story;
  VisitMoment head = nobody();
  head.head = true;
  EXPECT_EQ(story.go_on(4, head).tutorial, Tutorial::kGrab);
  EXPECT_EQ(story.go_on(2, head).tutorial, Tutorial::kShowHand);
  EXPECT_EQ(story.go_on(1, head).line, Line::kShowHand);
  EXPECT_EQ(story.go_on(1.5, hand(HandState::kReady)).tutorial, Tutorial::kGrab) << "now that it is";
}

TEST(Visit, WhereNobodySeesHeadsAHandThatSankIsAskedFor) {
  Story story;
  story.go_on(2, nobody());
  story.go_on(2, hand(HandState::kReady));
  const auto picture = story.go_on(3, nobody());
  EXPECT_EQ(picture.phase, VisitPhase::kLeaving);
  EXPECT_EQ(picture.tutorial, Tutorial::kShowHand);
  EXPECT_GT(picture.tutorial_s, 0.0);
  Story able;
  able.go_on(2, hand(HandState::kHolding, 2.0));
  EXPECT_FALSE(able.go_on(4, nobody()).tutorial) << "who can turn it knows";
}

TEST(Visit, AHandThatSankOutOfSightIsAskedForUntilItStays) {
  VisitMoment head = nobody(), low = hand(HandState::kReady), high = low;
  head.head = low.head = high.head = true;
  low.hand_y_m = -0.1;
  high.hand_y_m = 0.1;
  Story story;
  story.go_on(2, low);
  EXPECT_EQ(story.go_on(0.2, head).tutorial, Tutorial::kGrab) << "trackers lose a hand for a moment";
  EXPECT_EQ(story.go_on(0.4, head).tutorial, Tutorial::kShowHand);
  EXPECT_EQ(story.go_on(0.1, head).line, Line::kShowHand);
  EXPECT_EQ(story.go_on(0.5, low).tutorial, Tutorial::kShowHand) << "it is at the edge of what is seen";
  EXPECT_EQ(story.go_on(1.0, high).tutorial, Tutorial::kGrab);
  Story above;
  above.go_on(2, high);
  EXPECT_EQ(above.go_on(1, head).tutorial, Tutorial::kGrab);
  Story able;
  able.go_on(2, hand(HandState::kHolding, 2.0));
  able.go_on(2, low);
  EXPECT_NE(able.go_on(1, head).tutorial, Tutorial::kShowHand) << "who can turn it knows";
}

TEST(Visit, AHandThatSankIsWantedHigherAtOnceAndOnlyForAWhile) {
  VisitMoment low = hand(HandState::kReady), high = low;
  low.hand_y_m = -0.1;
  high.hand_y_m = 0.2;
  Story story;
  EXPECT_FALSE(story.go_on(2, low).higher_s);
  EXPECT_FALSE(story.go_on(0.1, nobody()).higher_s) << "trackers lose a hand for a moment";
  EXPECT_TRUE(story.go_on(0.3, nobody()).higher_s);
  EXPECT_TRUE(story.go_on(0.3, hand(HandState::kStranger)).higher_s) << "another hand is not this one";
  EXPECT_FALSE(story.go_on(0.1, low).higher_s) << "it is there again";
  VisitMoment head = nobody();
  head.head = true;
  EXPECT_TRUE(story.go_on(3, head).higher_s);
  EXPECT_FALSE(story.go_on(3, head).higher_s);
  EXPECT_FALSE(story.go_on(3, high).higher_s);
  EXPECT_FALSE(story.go_on(1, nobody()).higher_s) << "it did not leave downwards";
  Story able;
  able.go_on(2, hand(HandState::kHolding, 2.0));
  able.go_on(2, low);
  EXPECT_FALSE(able.go_on(1, nobody()).higher_s) << "who can turn it knows";
}

TEST(Visit, SaysWhatIsWrongWithAHandButNotWithOneThatPassesBy) {
  Story story;
  story.go_on(1, hand(HandState::kReady));
  EXPECT_NE(story.go_on(0.4, hand(HandState::kTooFar)).line, Line::kNearer);
  EXPECT_EQ(story.go_on(0.6, hand(HandState::kTooFar)).line, Line::kNearer);
  EXPECT_EQ(story.go_on(1, hand(HandState::kFist)).line, Line::kOpenFirst);
  EXPECT_EQ(story.go_on(1, hand(HandState::kStranger)).line, Line::kSomebodyElse);
}

TEST(Visit, ResetsOnceWhenTheObjectWasMovedAndNobodyComesBack) {
  Story story({.idle_reset_s = 20, .attract_after_s = 5});
  story.go_on(1, hand(HandState::kReady));
  story.go_on(2, hand(HandState::kHolding, 2.0));
  story.go_on(19, nobody());
  EXPECT_EQ(story.resets, 0);
  const auto picture = story.go_on(60, nobody());
  EXPECT_EQ(story.resets, 1);
  EXPECT_EQ(picture.phase, VisitPhase::kAttract);
}

TEST(Visit, NothingIsResetThatWasNotMoved) {
  Story story({.idle_reset_s = 20, .attract_after_s = 5});
  story.go_on(1, hand(HandState::kReady));
  const auto picture = story.go_on(60, nobody());
  EXPECT_EQ(story.resets, 0);
  EXPECT_EQ(picture.phase, VisitPhase::kAttract);
}

TEST(Visit, AHandThatIsLostForAMomentIsTheSameVisit) {
  Story story({.idle_reset_s = 20, .attract_after_s = 5});
  story.go_on(1, hand(HandState::kReady));
  story.go_on(2, hand(HandState::kHolding, 2.0));
  story.go_on(10, nobody());
  story.go_on(2, hand(HandState::kReady));
  EXPECT_EQ(story.arrivals, 1);
  EXPECT_EQ(story.resets, 0);
}

TEST(Visit, QuietHoursWaitForTheLastHand) {
  Story story({.idle_reset_s = 20, .attract_after_s = 5});
  story.go_on(3, hand(HandState::kHolding, 2.0));
  VisitMoment late = hand(HandState::kHolding, 2.0);
  late.asleep = true;
  EXPECT_NE(story.go_on(3, late).phase, VisitPhase::kAsleep);
  VisitMoment night = nobody();
  night.asleep = true;
  EXPECT_EQ(story.go_on(10, night).phase, VisitPhase::kAsleep);
  EXPECT_EQ(story.resets, 1);
  EXPECT_FALSE(story.go_on(3, night).line);
  EXPECT_EQ(story.go_on(1, nobody()).phase, VisitPhase::kAttract);
}

TEST(Visit, WithoutASensorItSaysSo) {
  Story story;
  VisitMoment moment;
  moment.tracker = false;
  EXPECT_EQ(story.go_on(1, moment).line, Line::kNoTracker);
}

TEST(Visit, AClockThatJumpsBackEndsNothing) {
  Visit visit({.idle_reset_s = 20, .attract_after_s = 5});
  visit.update(100'000'000'000, hand(HandState::kReady));
  visit.update(101'000'000'000, hand(HandState::kHolding, 40.0));
  const auto picture = visit.update(5'000'000'000, hand(HandState::kReady));
  EXPECT_EQ(picture.phase, VisitPhase::kFree);
  EXPECT_FALSE(picture.reset);
}

TEST(Visit, AHandThatNeverClosesIsTaughtToWipeAndToWalkTheTourAfterTwoLessons) {
  Visit visit;
  VisitMoment open = hand(HandState::kReady);
  open.can_tour = true;
  std::vector<Tutorial> shown;
  std::set<Line> said;
  for (TimestampNs now = 0; now < 60 * kSecondNs; now += 100'000'000) {
    const VisitPicture picture = visit.update(now, open);
    if (picture.tutorial && (shown.empty() || shown.back() != *picture.tutorial || picture.tutorial_s == 0.0))
      shown.push_back(*picture.tutorial);
    if (picture.line) said.insert(*picture.line);
  }
  ASSERT_GE(shown.size(), 5U);
  EXPECT_EQ(
      std::vector<Tutorial>(shown.begin(), shown.begin() + 5),
      (std::vector<Tutorial>{Tutorial::kGrab, Tutorial::kGrab, Tutorial::kSwipe, Tutorial::kRest, Tutorial::kSwipe}));
  EXPECT_TRUE(said.contains(Line::kRestTour));
  EXPECT_FALSE(said.contains(Line::kRest)) << "there is no envelope's sign before anything was turned";
  Visit once;  // who has closed it once is taught to take hold as ever
  for (TimestampNs now = 0; now < 40 * kSecondNs; now += 100'000'000) {
    VisitMoment moment = hand(now < kSecondNs ? HandState::kHolding : HandState::kReady);
    moment.can_tour = true;
    const VisitPicture picture = once.update(now, moment);
    EXPECT_NE(picture.tutorial, Tutorial::kSwipe);
  }
}

TEST(Visit, TwelveDegreesInOneHoldAreTurnedAndAsMuchInThreeAreNot) {
  for (const bool one : {true, false}) {
    Visit visit;
    for (int i = 0; i < 300; ++i) {
      VisitMoment moment = hand(HandState::kHolding, 0.04);
      moment.held_deg = 0.04 * (one ? i : i % 100);
      visit.update(i * kPicture, moment);
    }
    EXPECT_EQ(visit.counts().done[static_cast<std::size_t>(Tutorial::kTurn)], 0);
    VisitMoment moment = hand(HandState::kHolding, 0.1);
    moment.held_deg = one ? 12.1 : 4.1;
    visit.update(300 * kPicture, moment);
    EXPECT_EQ(visit.counts().done[static_cast<std::size_t>(Tutorial::kTurn)], one ? 1 : 0);
  }
}

}  // namespace
}  // namespace dubsar::app
