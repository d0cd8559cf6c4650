#include "input/gestures/grip_detector.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

constexpr double kForgetsOpenPerS = 0.25;  // of the strength that an open hand had

/// The index finger is stretched: from knuckle to tip it is 0.7 times as long as from wrist to knuckle then. False
/// where the joints are not known.
bool points(const HandFrame& hand) {
  const auto &wrist = hand.joint(HandJoint::kWrist), &knuckle = hand.joint(HandJoint::kIndexProximal),
             &tip = hand.joint(HandJoint::kIndexTip);
  if (!wrist.valid || !knuckle.valid || !tip.valid) return false;
  constexpr double kStretched = 0.6;
  return glm::length(tip.pose.position_m - knuckle.pose.position_m) >
         kStretched * glm::length(knuckle.pose.position_m - wrist.pose.position_m);
}

}  // namespace

void GripDetector::lose(TimestampNs now, std::vector<GestureEvent>& events) {
  if (grabbing_) events.push_back({now, GestureKind::kGrab, GesturePhase::kCancel});
  if (pinching_) events.push_back({now, GestureKind::kPinch, GesturePhase::kCancel});
  *this = {};
}

/// What closed is held for long enough, by a hand that was still when it closed. One that closed on its way, or moves
/// on before that is sure, must open before it can take hold. A hand that drifts is neither: it is waited for until it
/// is still, and what it began goes on. A hand that may be somebody else's rests until it holds.
GripDetector::Closing GripDetector::judge(const Moment& moment, const GestureOptions& options, bool closed,
                                          TimestampNs& since) {
  if (!closed) {
    since = -1;
    return Closing::kOpen;
  }
  const bool still = moment.still_ns >= options.grab.still_ns;
  const bool rests = options.grab.still_ns == 0 || moment.rests(options);
  if (!rests && !(still && moment.sure_person)) {
    since = -1;
    return Closing::kOnItsWay;
  }
  if (!still && since < 0) return Closing::kPerhaps;
  if (since < 0) since = moment.now;
  return moment.now - since >= options.grab.sure_ns ? Closing::kSure : Closing::kPerhaps;
}

void GripDetector::grab(const Moment& moment, const HandFrame& hand, const GestureOptions& options,
                        std::vector<GestureEvent>& events) {
  const double grab = hand.grab_strength;
  if (grabbing_) {
    closest_grab_ = std::max(closest_grab_, grab);
    const bool lets_go =
        closest_grab_ >= options.grab.on ? grab <= options.grab.off : grab <= closest_grab_ - options.grab.let_go;
    if (!lets_go) opened_since_ = -1;
    if (lets_go && opened_since_ < 0) opened_since_ = moment.now;
    if (lets_go && moment.now - opened_since_ >= options.grab.open_ns) {
      grabbing_ = false;
      open_grab_ = grab;
      pinch_armed_ = false;  // the fingers of an opening fist pass through a pinch
      events.push_back({moment.now, GestureKind::kGrab, GesturePhase::kEnd});
    }
  } else {
    const double slack = moment.beginner && closed_since_ >= 0 ? options.grab.beginner_slack : 0.0;
    const bool gently = grab >= options.grab.gentle - slack && grab - open_grab_ >= options.grab.rise - slack &&
                        !points(hand) && moment.rests(options);
    const bool closed = moment.may_begin && grab_armed_ && (grab >= options.grab.on || gently);
    Closing closing = judge(moment, options, closed, closed_since_);
    if (pinching_ && closed) closing = Closing::kSure;  // the thumb came first
    if (closing == Closing::kOpen)
      open_grab_ = std::min(grab, open_grab_ + kForgetsOpenPerS * 1e-9 * static_cast<double>(moment.since_ns));
    // What closes while the hand is on its way does not take hold when it has come: hands at the chin are half closed.
    if (closing == Closing::kOpen && moment.still_ns < options.grab.still_ns) open_grab_ = std::max(open_grab_, grab);
    if (closing == Closing::kOnItsWay) {
      grab_armed_ = false;
      open_grab_ = grab;
    } else if (closing == Closing::kSure) {
      if (pinching_) events.push_back({moment.now, GestureKind::kPinch, GesturePhase::kCancel});
      pinching_ = false;
      grabbing_ = true;
      grab_armed_ = false;
      closest_grab_ = grab;
      opened_since_ = closed_since_ = -1;
      events.push_back({moment.now, GestureKind::kGrab, GesturePhase::kBegin});
    }
  }
  if (grab <= (options.grab.still_ns > 0 ? options.grab.gentle : options.grab.off)) grab_armed_ = true;
}

void GripDetector::pinch(const Moment& moment, const HandFrame& hand, const GestureOptions& options,
                         std::vector<GestureEvent>& events) {
  if (pinching_) {
    if (hand.pinch_distance_m >= options.pinch.off_m) {
      pinching_ = false;
      events.push_back({moment.now, GestureKind::kPinch, GesturePhase::kEnd});
    }
  } else {
    const bool closed = moment.may_begin && pinch_armed_ && hand.pinch_distance_m <= options.pinch.on_m &&
                        hand.grab_strength <= options.grab.off;
    const Closing closing = judge(moment, options, closed, pinched_since_);
    if (closing == Closing::kOnItsWay || closing == Closing::kSure) pinch_armed_ = false;
    if (closing == Closing::kSure) {
      pinching_ = true;
      events.push_back({moment.now, GestureKind::kPinch, GesturePhase::kBegin});
    }
  }
  if (hand.pinch_distance_m >= options.pinch.off_m) pinch_armed_ = true;
}

void GripDetector::update(const Moment& moment, const HandFrame& hand, const GestureOptions& options,
                          std::vector<GestureEvent>& events) {
  grab(moment, hand, options, events);
  if (!grabbing_) pinch(moment, hand, options, events);
}

}  // namespace dubsar
