#include "devices/head_tracker/head_sample.h"

#include <algorithm>
#include <cmath>

namespace dubsar {

std::optional<HeadSample> HeadGate::pass(HeadSample sample) noexcept {
  if (sample.has_position)
    for (int i = 0; i < 3; ++i)
      if (!(std::abs(sample.pose.position_m[i]) <= box_m_)) return std::nullopt;
  if (sample.has_orientation) {
    const double length = glm::length(sample.pose.rotation);
    if (!(std::abs(length - 1.0) <= 0.01)) return std::nullopt;
    sample.pose.rotation /= length;
  }
  if (last_ && sample.has_position && last_->has_position && sample.time - last_->time <= 500'000'000) {
    // reports of one poll share their time, so that at least a millisecond is allowed for
    const double reach_m =
        kHeadSpeedMps * 1e-9 * static_cast<double>(std::max<TimestampNs>(sample.time - last_->time, 1'000'000));
    const glm::dvec3 step = sample.pose.position_m - last_->pose.position_m;
    const double distance_m = glm::length(step);
    if (distance_m > reach_m) sample.pose.position_m = last_->pose.position_m + step * (reach_m / distance_m);
  }
  last_ = sample;
  return sample;
}

}  // namespace dubsar
