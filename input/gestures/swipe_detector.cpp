#include "input/gestures/swipe_detector.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {
constexpr TimestampNs kRest = 100'000'000;
// A swipe that is counted at its end: straight enough, in one go, by a hand that stays where it ends.
constexpr double kBriskMps = 0.96;  // nobody talks with such a hand, it need not stay
constexpr double kSlanted = 0.6, kDeep = 0.45, kOpen = 0.3;
constexpr double kClosing_s = 0.08;
constexpr double kAsOpen = 0.08;  // who talks or points bends the fingers a little
constexpr TimestampNs kLongest = 1'400'000'000, kSettled = 120'000'000;

SwipeDirection direction_of(int axis, double sign) {
  return axis == 0 ? (sign > 0 ? SwipeDirection::kRight : SwipeDirection::kLeft)
                   : (sign > 0 ? SwipeDirection::kUp : SwipeDirection::kDown);
}

}  // namespace

std::optional<SwipeDirection> SwipeDetector::update(const Moment& moment, const GestureOptions& options) {
  if (!closing_) closing_ = most_open_ = moment.closing;
  *closing_ += std::min(1.0, 1e-9 * static_cast<double>(moment.since_ns) / kClosing_s) * (moment.closing - *closing_);
  most_open_ = std::min(most_open_, *closing_);
  return options.swipe.still_ns > 0 ? at_its_end(moment, options) : on_the_way(moment, options);
}

/// From rest, to one side, to rest again: neither a hand that comes nor one that leaves does that.
std::optional<SwipeDirection> SwipeDetector::at_its_end(const Moment& moment, const GestureOptions& options) {
  if (!moment.may_begin) {
    from_m_.reset();
    return std::nullopt;
  }
  const double speed = glm::length(moment.velocity_mps);
  const bool brisk = peak_mps_ >= std::max(kBriskMps, options.swipe.fast_mps) && speed <= 0.5 * peak_mps_;
  if (from_m_ && peak_mps_ >= options.swipe.fast_mps && (brisk || moment.still_ns >= kSettled)) {  // it came to its end
    const glm::dvec3 way = moment.at_m - *from_m_;
    const int axis = std::abs(way.x) >= std::abs(way.y) ? 0 : 1;
    const double along = std::abs(way[axis]);
    const bool swiped = along >= options.swipe.travel_m && std::abs(way[1 - axis]) <= kSlanted * along &&
                        std::abs(way.z) <= kDeep * along && moment.closing <= kOpen &&
                        (brisk || *closing_ - most_open_ <= kAsOpen) && moment.now - left_ <= kLongest &&
                        moment.may_end;
    from_m_.reset();
    if (swiped) return direction_of(axis, way[axis]);
  }
  if (moment.still_ns >= options.swipe.still_ns) {
    from_m_ = moment.at_m;
    left_ = moment.now;
    peak_mps_ = 0.0;
  } else {
    peak_mps_ = std::max(peak_mps_, speed);
  }
  return std::nullopt;
}

std::optional<SwipeDirection> SwipeDetector::on_the_way(const Moment& moment, const GestureOptions& options) {
  const TimestampNs now = moment.now;
  const glm::dvec3 &at_m = moment.at_m, &velocity_mps = moment.velocity_mps;
  if (swiped_) {
    const double along = velocity_mps[axis_] * sign_;
    if (std::abs(along) < options.swipe.end_mps) ended_ = true;
    if (std::abs(along) >= options.swipe.opposing_mps) slow_since_ = now;
    if (now - slow_since_ >= kRest) rested_ = true;  // a hand that turns round is slow for a moment only
  }
  if (!moment.may_begin || !moment.may_end) {
    from_m_.reset();
    return std::nullopt;
  }
  const int axis = std::abs(velocity_mps.x) >= std::abs(velocity_mps.y) ? 0 : 1;
  const double speed = std::abs(velocity_mps[axis]), sign = velocity_mps[axis] < 0 ? -1.0 : 1.0;
  const bool fast = speed > options.swipe.fast_mps && std::abs(velocity_mps[1 - axis]) < options.swipe.lateral_mps &&
                    std::abs(velocity_mps.z) < options.swipe.lateral_mps;
  if (!fast) {
    from_m_.reset();
    return std::nullopt;
  }
  if (!from_m_) from_m_ = at_m;
  if (std::abs((at_m - *from_m_)[axis]) < options.swipe.travel_m) return std::nullopt;
  if (swiped_ && (now - *swiped_ < options.swipe.lockout_ns || !ended_)) return std::nullopt;
  // The hand that comes back after a swipe is not a swipe to the other side: it must have rested first.
  if (swiped_ && axis == axis_ && sign != sign_ && !rested_) return std::nullopt;
  swiped_ = slow_since_ = now;
  ended_ = rested_ = false;
  axis_ = axis;
  sign_ = sign;
  return direction_of(axis, sign);
}

}  // namespace dubsar
