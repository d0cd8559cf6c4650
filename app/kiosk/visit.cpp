#include "app/kiosk/visit.h"

#include <algorithm>

#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr double kTurnedDeg = 25.0;         // in all, on purpose: further than a hand that only takes hold
constexpr double kTurnedInAHoldDeg = 12.0;  // as far as is seen as turned, and more than a tremble between two ends
constexpr double kZoomed = 0.15;            // a sixth larger or smaller
constexpr TimestampNs kPatience = 2 * kSecondNs;  // before the next thing is shown to somebody who is busy
constexpr TimestampNs kTutorialTime = 9 * kSecondNs, kTutorialRest = 6 * kSecondNs;
constexpr TimestampNs kUnseen = 5 * kSecondNs;     // without a hand, how to take hold makes room for how to be seen
constexpr TimestampNs kFirstRest = 300'000'000;    // as long as nothing was turned, nobody waits for the next picture
constexpr TimestampNs kTroubleTime = 700'000'000;  // a hand that passes by is not spoken to
constexpr TimestampNs kGone = 2 * kSecondNs;       // a lost hand mostly comes back
constexpr double kLowM = 0.0;                      // below the panel's middle
constexpr TimestampNs kSunk = 300'000'000, kBack = kSecondNs, kAskedLong = 6 * kSecondNs;
constexpr double kPerhapsLowM = 0.08;  // the further from the screen, the higher the sensor's sight ends
constexpr TimestampNs kVanished = 200'000'000, kWantedLong = 4 * kSecondNs;
constexpr int kMostShown = 3, kGrabMostShown = 6;  // nothing else goes without it
constexpr int kOpenHandShown = 2;  // tutorials to close a hand, before an open one is taught what it can do

constexpr std::size_t index(Tutorial tutorial) { return static_cast<std::size_t>(tutorial); }
TimestampNs ns(double seconds) { return static_cast<TimestampNs>(1e9 * seconds); }

Line line_of(Tutorial tutorial) {
  switch (tutorial) {
    case Tutorial::kShowHand:
      return Line::kShowHand;
    case Tutorial::kGrab:
      return Line::kGrab;
    case Tutorial::kTurn:
      return Line::kTurn;
    case Tutorial::kRest:
      return Line::kRest;
    case Tutorial::kTwoHands:
      return Line::kTwoHands;
    case Tutorial::kSwipe:
      break;
  }
  return Line::kSwipe;
}

}  // namespace

void Visit::begin(TimestampNs now) {
  phase_ = VisitPhase::kArrived;
  course_ = {};
  course_.rests_until = now;
  ++counts_.visits;
}

void Visit::done(Tutorial tutorial) {
  if (course_.done[index(tutorial)]) return;
  course_.done[index(tutorial)] = true;
  ++counts_.done[index(tutorial)];
}

void Visit::learn(const VisitMoment& moment) {
  course_.turned_deg += moment.turned_deg;
  course_.zoomed += moment.zoomed;
  if (moment.hands > 0 && moment.hand <= HandState::kFist) done(Tutorial::kShowHand);
  if (moment.hands > 0 && moment.hand == HandState::kHolding) done(Tutorial::kGrab);
  if (course_.turned_deg >= kTurnedDeg || moment.held_deg >= kTurnedInAHoldDeg) done(Tutorial::kTurn);
  if (course_.zoomed >= kZoomed) done(Tutorial::kTwoHands);
  if (moment.chose_open) {
    done(Tutorial::kRest);
    ++counts_.openings;
  }
  if (moment.swiped) done(Tutorial::kSwipe);
  touched_ = touched_ || moment.turned_deg > 0 || moment.zoomed > 0 || moment.chose_open || moment.swiped;
  if (course_.done[index(Tutorial::kTurn)]) phase_ = VisitPhase::kFree;
}

/// Was shown twice how to close, and did not: who cannot, or would not, wipes and walks the tour.
bool Visit::never_closes(const VisitMoment& moment) const {
  return moment.hands > 0 && !course_.done[index(Tutorial::kGrab)] &&
         course_.shown[index(Tutorial::kGrab)] >= kOpenHandShown;
}

std::optional<Tutorial> Visit::next(const VisitMoment& moment) const {
  if (never_closes(moment)) {  // each as often as the other
    const int swipes = course_.shown[index(Tutorial::kSwipe)], tours = course_.shown[index(Tutorial::kRest)];
    const bool swipe = !course_.done[index(Tutorial::kSwipe)] && swipes < kMostShown;
    const bool tour = moment.can_tour && tours < kMostShown;
    if (swipe && (swipes <= tours || !tour)) return Tutorial::kSwipe;
    if (tour) return Tutorial::kRest;
  }
  for (std::size_t i = 0; i < kTutorialCount; ++i) {
    const auto tutorial = static_cast<Tutorial>(i);
    const bool holds = moment.hands > 0 && moment.hand == HandState::kHolding;
    if (tutorial == Tutorial::kShowHand && course_.shown[index(Tutorial::kGrab)] == 0)
      continue;                         // that shows a hand, too
    if (tutorial == Tutorial::kGrab) {  // taken, moved and let go: until the object was turned so
      if (course_.done[index(Tutorial::kTurn)] || holds || course_.shown[i] >= kGrabMostShown) continue;
      return tutorial;
    }
    if (course_.done[i] || course_.shown[i] >= kMostShown) continue;
    if (tutorial == Tutorial::kTurn && !holds) continue;
    if (tutorial == Tutorial::kRest && !moment.can_open) continue;
    return tutorial;
  }
  return std::nullopt;
}

void Visit::teach(TimestampNs now, const VisitMoment& moment) {
  const bool holds = moment.hands > 0 && moment.hand == HandState::kHolding;
  if (course_.now) {
    const std::size_t shown = index(*course_.now);
    const bool again = *course_.now == Tutorial::kTurn && !holds;  // it let go: back to taking hold
    const bool success = *course_.now == Tutorial::kGrab ? holds : course_.done[shown];
    const bool unseen = *course_.now == Tutorial::kGrab && !course_.done[index(Tutorial::kShowHand)] &&
                        course_.shown[index(Tutorial::kShowHand)] == 0;
    if (!success && !again && now - course_.since < (unseen ? kUnseen : kTutorialTime)) return;
    course_.now.reset();
    const bool beginner = !course_.done[index(Tutorial::kTurn)];
    if (beginner)  // who has just taken hold may know how to go on
      course_.rests_until = now + (again ? 0 : success ? kSecondNs : kFirstRest);
    else
      course_.rests_until = now + (success ? kPatience : kTutorialRest);
  }
  // Nobody is interrupted while the object turns in the hand.
  if (holds && course_.done[index(Tutorial::kTurn)])
    course_.rests_until = std::max(course_.rests_until, now + kPatience);
  if (now < course_.rests_until) return;
  course_.now = next(moment);
  if (!course_.now) return;
  course_.since = now;
  ++course_.shown[index(*course_.now)];
}

/// As long as nothing was turned: a hand that was low when it was last seen has sunk below what the sensor sees. It is
/// asked for until it is seen for good.
void Visit::ask_for_height(TimestampNs now, const VisitMoment& moment) {
  Course& c = course_;
  if (c.done[index(Tutorial::kTurn)] || moment.toured || !moment.tracker) {
    c.asked = -1;
    return;
  }
  if (moment.hands > 0) {
    if (c.seen_since < 0) c.seen_since = now;
    c.lost_since = -1;
    c.low = moment.hand_y_m < kLowM;
  } else {
    if (c.lost_since < 0) c.lost_since = now;
    c.seen_since = -1;
  }
  if (c.asked < 0) {
    if (moment.hands == 0 && c.low && c.done[index(Tutorial::kShowHand)] && now - c.lost_since >= kSunk &&
        c.sank < kMostShown) {
      c.asked = now;
      ++c.sank;
    }
  } else if ((c.seen_since >= 0 && now - c.seen_since >= kBack) || now - c.asked >= kAskedLong) {
    c.asked = -1;
    c.low = false;
  }
}

/// Likewise, at the place where it was lost, at once: whoever looks at the ring of his hand sees it stay behind.
std::optional<double> Visit::sunk_s(TimestampNs now, const VisitMoment& moment) {
  Course& c = course_;
  if (c.done[index(Tutorial::kTurn)] || moment.toured || !moment.tracker) return std::nullopt;
  if (moment.hands > 0 && moment.hand <= HandState::kFist) {
    c.followed = moment.hand_y_m < kPerhapsLowM ? now : -1;
    return std::nullopt;
  }
  if (c.followed < 0 || now - c.followed < kVanished || now - c.followed > kVanished + kWantedLong) return std::nullopt;
  return 1e-9 * static_cast<double>(now - c.followed - kVanished);
}

std::optional<Line> Visit::line(const VisitMoment& moment) const {
  if (trouble_since_ >= 0 && last_ - trouble_since_ >= kTroubleTime) {
    if (moment.hand == HandState::kTooFar) return Line::kNearer;
    if (moment.hand == HandState::kFist) return Line::kOpenFirst;
    if (moment.hand == HandState::kStranger) return Line::kSomebodyElse;
  }
  if (course_.asked >= 0) return Line::kShowHand;
  if (course_.now == Tutorial::kRest && phase_ == VisitPhase::kArrived) return Line::kRestTour;
  if (course_.now) return line_of(*course_.now);
  return std::nullopt;
}

VisitPicture Visit::update(TimestampNs now, const VisitMoment& moment) {
  VisitPicture out;
  const bool first = last_ < 0;
  last_ = first ? now : std::max(now, last_);  // a clock that jumps back holds the visit still
  if (first) last_hand_ = last_somebody_ = last_ - ns(figures_.attract_after_s);
  const bool somebody = moment.head || moment.hands > 0 || moment.toured;
  touched_ = touched_ || moment.toured;
  if (moment.hands > 0 || moment.toured) last_hand_ = last_;
  if (somebody) last_somebody_ = last_;
  const bool trouble = moment.hands > 0 && moment.hand > HandState::kReady;
  if (!trouble) trouble_since_ = -1;
  if (trouble && trouble_since_ < 0) trouble_since_ = last_;

  if (moment.asleep && moment.hands == 0 && last_ - last_hand_ >= ns(figures_.attract_after_s)) {
    out.reset = phase_ != VisitPhase::kAsleep && touched_;
    phase_ = VisitPhase::kAsleep;
  } else if (phase_ == VisitPhase::kAsleep && !moment.asleep) {
    phase_ = VisitPhase::kAttract;
  }
  const bool waits = phase_ == VisitPhase::kAttract || phase_ == VisitPhase::kAsleep;
  if (waits && (moment.hands > 0 || (moment.head && phase_ == VisitPhase::kAttract))) {
    begin(last_);
    out.arrived = true;
  }
  if (phase_ == VisitPhase::kLeaving && moment.hands > 0)
    phase_ = course_.done[index(Tutorial::kTurn)] ? VisitPhase::kFree : VisitPhase::kArrived;  // back in time
  if (phase_ == VisitPhase::kArrived || phase_ == VisitPhase::kFree) {
    learn(moment);
    if (moment.toured || (moment.touch && !moment.tracker))  // fingers need no tutorial in fists
      course_.now.reset();
    else
      teach(last_, moment);
    ask_for_height(last_, moment);
    out.higher_s = sunk_s(last_, moment);
    if (!somebody && last_ - last_somebody_ >= kGone) phase_ = VisitPhase::kLeaving;
  }
  if (phase_ == VisitPhase::kLeaving) course_.now.reset();
  const bool alone = last_ - last_hand_ >= ns(figures_.idle_reset_s) ||
                     (!touched_ && last_ - last_somebody_ >= ns(figures_.attract_after_s));
  if (alone && !waits && !(somebody && !touched_)) {
    out.reset = touched_;
    phase_ = VisitPhase::kAttract;
    course_.now.reset();
  }
  if (out.reset) {
    touched_ = false;
    ++counts_.resets;
  }
  out.phase = phase_;
  out.tutorial = course_.now;
  if (course_.now) out.tutorial_s = 1e-9 * static_cast<double>(last_ - course_.since);
  if (phase_ == VisitPhase::kAttract && moment.tracker) {  // the invitation
    out.tutorial = Tutorial::kGrab;
    out.tutorial_s = 1e-9 * static_cast<double>(last_);
  }
  // Where no camera sees heads, somebody may still be there whose hand is too low to be seen.
  if (phase_ == VisitPhase::kLeaving && moment.tracker && !course_.done[index(Tutorial::kTurn)]) {
    out.tutorial = Tutorial::kShowHand;
    out.tutorial_s = 1e-9 * static_cast<double>(last_);
    out.line = Line::kShowHand;
  }
  if (course_.asked >= 0 && phase_ == VisitPhase::kArrived) {
    out.tutorial = Tutorial::kShowHand;
    out.tutorial_s = 1e-9 * static_cast<double>(last_ - course_.asked);
  }
  if (phase_ == VisitPhase::kAttract)
    out.line = moment.tracker ? Line::kInvite : moment.touch ? Line::kTouch : Line::kNoTracker;
  if (phase_ == VisitPhase::kArrived || phase_ == VisitPhase::kFree) out.line = line(moment);
  return out;
}

}  // namespace dubsar::app
