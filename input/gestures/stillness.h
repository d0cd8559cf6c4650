#pragma once
// How long a hand has been held still.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/base/system/clock.h"

namespace dubsar {

/// Still means that the hand stays within 20 mm of where it came to rest; trembling and noise are less than that.
class Stillness {
 public:
  void update(TimestampNs now, const glm::dvec3& at_m) {
    constexpr double kRadiusM = 0.02;
    if (since_ >= 0 && glm::length(at_m - at_m_) <= kRadiusM) return;
    at_m_ = at_m;
    since_ = now;
  }
  void lose() { since_ = -1; }
  /// 0 when nothing is seen.
  TimestampNs still_for(TimestampNs now) const noexcept { return since_ < 0 ? 0 : now - since_; }

 private:
  glm::dvec3 at_m_{0.0};
  TimestampNs since_ = -1;
};

}  // namespace dubsar
