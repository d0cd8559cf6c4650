#pragma once
// When the light of a picture that is begun now reaches the eye: from the monitor's rate and from when
// pictures were presented. Pure arithmetic.

#include <algorithm>

#include "core/base/system/clock.h"

namespace dubsar::app {

class DisplayClock {
 public:
  /// A monitor that does not say its rate counts as 60 Hz.
  explicit DisplayClock(double refresh_hz = 0.0) { set_refresh(refresh_hz); }

  void set_refresh(double refresh_hz) noexcept {
    const double hz = refresh_hz >= 1.0 && refresh_hz <= 1000.0 ? refresh_hz : 60.0;
    period_ns_ = static_cast<TimestampNs>(1e9 / hz);
  }
  TimestampNs period() const noexcept { return period_ns_; }

  /// A picture was begun at `begun`, ready at `drawn`, and the call that presents it came back at
  /// `presented`.
  void presented(TimestampNs begun, TimestampNs drawn, TimestampNs presented) noexcept {
    const TimestampNs cost = std::clamp<TimestampNs>(drawn - begun, 0, kMostCostNs);
    cost_ns_ = last_ < 0 ? cost : (7 * cost_ns_ + 3 * cost) / 10;
    last_ = presented;
  }

  /// The middle of the scan-out in which a picture begun at `now` will be seen: the first beat after it is
  /// ready.
  TimestampNs light(TimestampNs now) const noexcept {
    const TimestampNs ready = now + cost_ns_;
    if (last_ < 0) return ready + period_ns_ + period_ns_ / 2;
    const TimestampNs since = std::max<TimestampNs>(ready - last_, 1);
    return last_ + (since + period_ns_ - 1) / period_ns_ * period_ns_ + period_ns_ / 2;
  }

  /// Earliest time for the next picture where the driver does not wait for the monitor; pictures that nobody
  /// sees are not made.
  TimestampNs next_start() const noexcept { return last_ < 0 ? 0 : last_ - cost_ns_ + period_ns_; }

 private:
  static constexpr TimestampNs kMostCostNs = 500'000'000;
  TimestampNs period_ns_ = 16'666'667, cost_ns_ = 0, last_ = -1;
};

}  // namespace dubsar::app
