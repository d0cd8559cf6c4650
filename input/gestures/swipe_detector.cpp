#include "input/gestures/swipe_detector.h"

#include <cmath>

namespace dubsar {
namespace {
constexpr TimestampNs kRest = 100'000'000;
}  // namespace

std::optional<SwipeDirection> SwipeDetector::update(TimestampNs now, const glm::dvec3& at_m,
                                                    const glm::dvec3& velocity_mps, bool may_begin,
                                                    const GestureOptions& options) {
  if (swiped_) {
    const double along = velocity_mps[axis_] * sign_;
    if (std::abs(along) < options.swipe_end_mps) ended_ = true;
    if (std::abs(along) >= options.swipe_opposing_mps) slow_since_ = now;
    if (now - slow_since_ >= kRest) rested_ = true;  // a hand that turns round is slow for a moment only
  }
  if (!may_begin) {
    from_m_.reset();
    return std::nullopt;
  }
  const int axis = std::abs(velocity_mps.x) >= std::abs(velocity_mps.y) ? 0 : 1;
  const double speed = std::abs(velocity_mps[axis]), sign = velocity_mps[axis] < 0 ? -1.0 : 1.0;
  const bool fast = speed > options.swipe_mps && std::abs(velocity_mps[1 - axis]) < options.swipe_lateral_mps &&
                    std::abs(velocity_mps.z) < options.swipe_lateral_mps;
  if (!fast) {
    from_m_.reset();
    return std::nullopt;
  }
  if (!from_m_) from_m_ = at_m;
  if (std::abs((at_m - *from_m_)[axis]) < options.swipe_travel_m) return std::nullopt;
  if (swiped_ && (now - *swiped_ < options.swipe_lockout_ns || !ended_)) return std::nullopt;
  // The hand that comes back after a swipe is not a swipe to the other side: it must have rested first.
  if (swiped_ && axis == axis_ && sign != sign_ && !rested_) return std::nullopt;
  swiped_ = slow_since_ = now;
  ended_ = rested_ = false;
  axis_ = axis;
  sign_ = sign;
  return axis == 0 ? (sign > 0 ? SwipeDirection::kRight : SwipeDirection::kLeft)
                   : (sign > 0 ? SwipeDirection::kUp : SwipeDirection::kDown);
}

}  // namespace dubsar
