#pragma once
// A hand that wipes to a side.

#include <glm/vec3.hpp>
#include <optional>

#include "input/gestures/gesture_event.h"
#include "input/gestures/gesture_options.h"

namespace dubsar {

class SwipeDetector {
 public:
  /// The palm as it was measured, and its velocity; `may_begin` false: the hand holds something, or has just come.
  /// The direction when a swipe happened now. One thread.
  std::optional<SwipeDirection> update(TimestampNs now, const glm::dvec3& at_m, const glm::dvec3& velocity_mps,
                                       bool may_begin, const GestureOptions& options);
  /// The hand is gone.
  void lose() { *this = {}; }

 private:
  std::optional<TimestampNs> swiped_;
  TimestampNs slow_since_ = 0;
  bool ended_ = true, rested_ = true;
  int axis_ = 0;
  double sign_ = 0.0;
  std::optional<glm::dvec3> from_m_;
};

}  // namespace dubsar
