#pragma once
// From a device's own clock to the host's, so that a report that was held up on its way still has the time of
// its measurement.

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/system/clock.h"

namespace dubsar {

/// Takes the quickest delivery so far as the offset between both clocks, letting it rise by 100 us per s for
/// clocks that drift apart. A delay that all reports have in common cannot be seen. One thread.
class DeviceTimeline {
 public:
  /// Host time of a measurement made at `device` (any origin, ns) whose report came at `arrived`; never later
  /// than that. A device clock that jumps by more than 1 s starts afresh.
  TimestampNs host_time(TimestampNs device, TimestampNs arrived) noexcept {
    const double offset = static_cast<double>(arrived) - static_cast<double>(device);  // cannot overflow
    if (offset_ && std::abs(offset - *offset_) <= kJump) {
      const double risen = *offset_ + kDrift * static_cast<double>(std::max<TimestampNs>(arrived - last_, 0));
      offset_ = std::min(offset, risen);
    } else {
      offset_ = offset;
    }
    last_ = arrived;
    return arrived - static_cast<TimestampNs>(offset - *offset_);
  }

 private:
  static constexpr double kJump = 1e9, kDrift = 1e-4;
  std::optional<double> offset_;
  TimestampNs last_ = 0;
};

}  // namespace dubsar
