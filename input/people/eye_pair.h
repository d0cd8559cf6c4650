#pragma once
// Both eyes' places from a tracker that loses one of them now and then.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "core/base/system/clock.h"

namespace dubsar {

struct EyeSample {
  TimestampNs time = 0;
  std::optional<glm::dvec3> left_m, right_m;  ///< panel frame
};

struct EyesSeen {
  glm::dvec3 left_m{0.0}, right_m{0.0};
  bool rebuilt = false;  ///< one eye was not seen and stands where the other one says
};

/// Fills in a missing eye from the last distance vector between both, for at most 300 ms (as gaze trackers do); longer
/// than that, or with neither eye, there is no pair.
class EyePairKeeper {
 public:
  explicit EyePairKeeper(TimestampNs expires_ns = 300'000'000) : expires_ns_(expires_ns) {}

  std::optional<EyesSeen> update(const EyeSample& sample) noexcept {
    if (sample.left_m && sample.right_m) {
      left_to_right_m_ = *sample.right_m - *sample.left_m;
      both_seen_ = sample.time;
      return EyesSeen{*sample.left_m, *sample.right_m, false};
    }
    if (!both_seen_ || sample.time - *both_seen_ > expires_ns_) return std::nullopt;
    if (sample.left_m) return EyesSeen{*sample.left_m, *sample.left_m + left_to_right_m_, true};
    if (sample.right_m) return EyesSeen{*sample.right_m - left_to_right_m_, *sample.right_m, true};
    return std::nullopt;
  }

 private:
  TimestampNs expires_ns_;
  std::optional<TimestampNs> both_seen_;
  glm::dvec3 left_to_right_m_{0.063, 0.0, 0.0};
};

}  // namespace dubsar
