#pragma once
// A hand that wipes to a side.

#include <glm/vec3.hpp>
#include <optional>

#include "input/gestures/gesture_event.h"
#include "input/gestures/gesture_options.h"

namespace dubsar {

class SwipeDetector {
 public:
  struct Moment {
    TimestampNs now = 0, still_ns = 0;        ///< for how long the hand has been held still
    glm::dvec3 at_m{0.0}, velocity_mps{0.0};  ///< of the palm, as it was measured
    double closing = 0.0;                     ///< 0: open, 1: a fist
    TimestampNs since_ns = 0;                 ///< since the sample before
    bool may_begin = true;                    ///< false: the hand holds something, or has just come
    bool may_end = true;                      ///< false: whose hand it is was not known for long enough
  };
  /// The direction when a swipe happened now. One thread.
  std::optional<SwipeDirection> update(const Moment& moment, const GestureOptions& options);
  /// The hand is gone.
  void lose() { *this = {}; }
  /// What has begun is none.
  void let_go() { from_m_.reset(); }

 private:
  std::optional<SwipeDirection> on_the_way(const Moment& moment, const GestureOptions& options);
  std::optional<SwipeDirection> at_its_end(const Moment& moment, const GestureOptions& options);

  std::optional<TimestampNs> swiped_;
  TimestampNs slow_since_ = 0;
  bool ended_ = true, rested_ = true;
  int axis_ = 0;
  double sign_ = 0.0;
  std::optional<glm::dvec3> from_m_;  // where it was fast first, or still last
  TimestampNs left_ = 0;              // that place
  double peak_mps_ = 0.0;
  std::optional<double> closing_;  // without noise
  double most_open_ = 1.0;         // how open the hand was at most
};

}  // namespace dubsar
