#pragma once
// How long a hand has been held still.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "core/base/system/clock.h"
#include "input/gestures/closing_fingers.h"

namespace dubsar {

/// Still means that the hand stays within 20 mm of where it came to rest; trembling and noise are less than that.
/// Closing fingers may take it further, and it rests there.
class Stillness {
 public:
  void update(TimestampNs now, const glm::dvec3& at_m, bool closing) {
    constexpr double kRadiusM = 0.02;
    if (!closing) closing_from_m_.reset();
    if (closing && !closing_from_m_) closing_from_m_ = at_m_;
    if (since_ >= 0 && glm::length(at_m - at_m_) <= kRadiusM) return;
    at_m_ = at_m;
    if (since_ >= 0 && closing && glm::length(at_m - *closing_from_m_) <= ClosingFingers::kPalmM) return;
    since_ = now;
  }
  void lose() { *this = {}; }
  /// 0 when nothing is seen.
  TimestampNs still_for(TimestampNs now) const noexcept { return since_ < 0 ? 0 : now - since_; }

 private:
  glm::dvec3 at_m_{0.0};
  std::optional<glm::dvec3> closing_from_m_;  ///< where the fingers began to close
  TimestampNs since_ = -1;
};

}  // namespace dubsar
