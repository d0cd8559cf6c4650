#include "input/gestures/gesture.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {
// A palm at rest is steadied to a few tenths of a millimetre, one at 200 mm/s lags 20 ms. Tuned on 1 mm of noise at 90
// Hz.
constexpr OneEuroOptions kPalmFilter{2.0, 30.0, 3.0};
constexpr TimestampNs kVelocityWindow = 60'000'000;
constexpr TimestampNs kRest = 100'000'000;
constexpr double kForgetsOpen_per_s = 0.25;  // of the strength that an open hand had
}  // namespace

namespace {

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

GestureRecognizer::GestureRecognizer(const GestureOptions& options)
    : options_(options), filter_(kPalmFilter), history_(kVelocityWindow) {}

void GestureRecognizer::add(TimestampNs now, GestureKind kind, GesturePhase phase, SwipeDirection direction) {
  events_.push_back({now, kind, phase, direction});
}

void GestureRecognizer::lose(TimestampNs now) {
  if (grabbing_) add(now, GestureKind::kGrab, GesturePhase::kCancel);
  if (pinching_) add(now, GestureKind::kPinch, GesturePhase::kCancel);
  grabbing_ = pinching_ = grab_armed_ = pinch_armed_ = dwelt_ = false;
  open_grab_ = 1.0;
  came_.reset();
  swiped_.reset();
  dwell_since_.reset();
  swipe_from_m_.reset();
  swipe_ended_ = swipe_rested_ = true;
  swipe_sign_ = dwell_progress_ = 0.0;
  velocity_mps_ = glm::dvec3(0.0);
  filter_.reset();
  history_.clear();
}

void GestureRecognizer::update(TimestampNs now, const HandFrame* hand) {
  events_.clear();
  seen_now_ = hand != nullptr && hand->valid && hand->tracked && hand->time > last_sample_;
  if (!seen_now_) {
    if (came_ && now - last_seen_ > options_.hold_ns) lose(now);
    return;
  }
  if (came_ && now - last_seen_ > options_.hold_ns) lose(now);  // polled rarely: the gap shows only now
  const TimestampNs since_ns = last_sample_ < 0 ? 0 : hand->time - last_sample_;
  last_sample_ = hand->time;
  last_seen_ = now;
  if (!came_) came_ = now;
  position_m_ = filter_.filter(hand->time, hand->palm.position_m);
  cursor_m_ = cursor_point_m(*hand);
  history_.add({hand->time, hand->palm.position_m});
  velocity_mps_ = history_.velocity_mps();
  grab_and_pinch(now, *hand, since_ns);
  swipe(now);
  dwell(now);
}

void GestureRecognizer::grab_and_pinch(TimestampNs now, const HandFrame& hand, TimestampNs since_ns) {
  const bool may_begin = now - *came_ >= options_.cooldown_ns;
  const double grab = hand.grab_strength;
  closest_grab_ = std::max(closest_grab_, grab);
  const bool lets_go =
      closest_grab_ >= options_.grab_on ? grab <= options_.grab_off : grab <= closest_grab_ - options_.grab_let_go;
  const bool gently = grab >= options_.grab_gentle && grab - open_grab_ >= options_.grab_rise && !points(hand) &&
                      glm::length(velocity_mps_) <= options_.grab_rest_mps;
  if (!grabbing_) open_grab_ = std::min(grab, open_grab_ + kForgetsOpen_per_s * 1e-9 * static_cast<double>(since_ns));
  if (grabbing_ && lets_go) {
    grabbing_ = false;
    open_grab_ = grab;
    pinch_armed_ = false;  // the fingers of an opening fist pass through a pinch
    add(now, GestureKind::kGrab, GesturePhase::kEnd);
  } else if (!grabbing_ && may_begin && grab_armed_ && (grab >= options_.grab_on || gently)) {
    if (pinching_) add(now, GestureKind::kPinch, GesturePhase::kCancel);
    pinching_ = false;
    grabbing_ = true;
    grab_armed_ = false;
    closest_grab_ = grab;
    add(now, GestureKind::kGrab, GesturePhase::kBegin);
  }
  if (grab <= options_.grab_off) grab_armed_ = true;
  if (grabbing_) return;
  if (pinching_ && hand.pinch_distance_m >= options_.pinch_off_m) {
    pinching_ = false;
    add(now, GestureKind::kPinch, GesturePhase::kEnd);
  } else if (!pinching_ && may_begin && pinch_armed_ && hand.pinch_distance_m <= options_.pinch_on_m &&
             hand.grab_strength <= options_.grab_off) {
    pinching_ = true;
    pinch_armed_ = false;
    add(now, GestureKind::kPinch, GesturePhase::kBegin);
  }
  if (hand.pinch_distance_m >= options_.pinch_off_m) pinch_armed_ = true;
}

void GestureRecognizer::swipe(TimestampNs now) {
  if (swiped_) {
    const double along = velocity_mps_[swipe_axis_] * swipe_sign_;
    if (std::abs(along) < options_.swipe_end_mps) swipe_ended_ = true;
    if (std::abs(along) >= options_.swipe_opposing_mps) slow_since_ = now;
    if (now - slow_since_ >= kRest) swipe_rested_ = true;  // a hand that turns round is slow for a moment only
  }
  if (grabbing_ || pinching_ || now - *came_ < options_.cooldown_ns) {
    swipe_from_m_.reset();
    return;
  }
  const int axis = std::abs(velocity_mps_.x) >= std::abs(velocity_mps_.y) ? 0 : 1;
  const double speed = std::abs(velocity_mps_[axis]), sign = velocity_mps_[axis] < 0 ? -1.0 : 1.0;
  const bool fast = speed > options_.swipe_mps && std::abs(velocity_mps_[1 - axis]) < options_.swipe_lateral_mps &&
                    std::abs(velocity_mps_.z) < options_.swipe_lateral_mps;
  if (!fast) {
    swipe_from_m_.reset();
    return;
  }
  const glm::dvec3& at_m = history_.newest().position_m;
  if (!swipe_from_m_) swipe_from_m_ = at_m;
  if (std::abs((at_m - *swipe_from_m_)[axis]) < options_.swipe_travel_m) return;
  if (swiped_ && (now - *swiped_ < options_.swipe_lockout_ns || !swipe_ended_)) return;
  // The hand that comes back after a swipe is not a swipe to the other side: it must have rested first.
  if (swiped_ && axis == swipe_axis_ && sign != swipe_sign_ && !swipe_rested_) return;
  swiped_ = slow_since_ = now;
  swipe_ended_ = swipe_rested_ = false;
  swipe_axis_ = axis;
  swipe_sign_ = sign;
  const auto direction = axis == 0 ? (sign > 0 ? SwipeDirection::kRight : SwipeDirection::kLeft)
                                   : (sign > 0 ? SwipeDirection::kUp : SwipeDirection::kDown);
  add(now, GestureKind::kSwipe, GesturePhase::kDone, direction);
}

void GestureRecognizer::dwell(TimestampNs now) {
  const bool still = dwell_since_ && glm::length(cursor_m_ - dwell_at_m_) <= options_.dwell_radius_m;
  if (grabbing_ || pinching_ || !still || now - *came_ < options_.cooldown_ns) {
    dwell_since_ = now;
    dwell_at_m_ = cursor_m_;
    dwell_progress_ = 0.0;
    dwelt_ = false;
    return;
  }
  const double filled =
      static_cast<double>(now - *dwell_since_ - options_.dwell_start_ns) / static_cast<double>(options_.dwell_fill_ns);
  dwell_progress_ = dwelt_ ? 0.0 : std::clamp(filled, 0.0, 1.0);
  if (filled < 1.0 || dwelt_) return;
  dwelt_ = true;
  add(now, GestureKind::kDwell, GesturePhase::kDone);
}

}  // namespace dubsar
