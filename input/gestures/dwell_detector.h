#pragma once
// A hand that is held still on purpose.

#include <glm/vec3.hpp>
#include <optional>

#include "input/gestures/gesture_options.h"

namespace dubsar {

class DwellDetector {
 public:
  /// Where the hand points; `may_begin` false: it holds something, or has just come. True once for each rest, when it
  /// was long enough. One thread.
  bool update(TimestampNs now, const glm::dvec3& cursor_m, bool may_begin, const GestureOptions& options);
  /// The hand is gone.
  void lose() { *this = {}; }
  double progress() const noexcept { return progress_; }  ///< 0..1

 private:
  std::optional<TimestampNs> since_;
  glm::dvec3 at_m_{0.0};
  bool done_ = false;  // once per rest
  double progress_ = 0.0;
};

}  // namespace dubsar
