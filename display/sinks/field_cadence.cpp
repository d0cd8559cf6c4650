#include "display/sinks/field_cadence.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

// Of a second-order loop: slow against the jitter of returning calls, fast against the drift of clocks. Calls come back
// late and never early, so what looks early counts ten times as much: the loop follows the earliest ones.
constexpr double kPhaseGain = 0.3, kPeriodGain = 0.01, kLateWeight = 0.1;
constexpr double kGuard = 0.25;       // of a beat, before it: too near to tell
constexpr double kBehind = 0.02;      // of a beat, after it: surely past
constexpr double kMostDetune = 0.01;  // of the period: 59.94 and 60 Hz are 0.1 % apart

}  // namespace

void FieldCadence::set_refresh(double refresh_hz) noexcept {
  nominal_ns_ = period_ns_ = 1e9 / (refresh_hz >= 1.0 && refresh_hz <= 1000.0 ? refresh_hz : 60.0);
  last_ns_ = -1.0;
  beats_ = 0;
}

void FieldCadence::presented(TimestampNs at) noexcept {
  const auto now = static_cast<double>(at);
  if (last_ns_ < 0.0) {
    last_ns_ = now;
    return;
  }
  const double passed = std::max(1.0, std::round((now - last_ns_) / period_ns_));
  const double late = now - last_ns_ - passed * period_ns_;
  beats_ += static_cast<std::int64_t>(passed);
  const double error = late > 0.0 ? kLateWeight * late : late;
  last_ns_ += passed * period_ns_ + kPhaseGain * error;
  period_ns_ = std::clamp(period_ns_ + kPeriodGain * error / passed, nominal_ns_ * (1.0 - kMostDetune),
                          nominal_ns_ * (1.0 + kMostDetune));
}

TimestampNs FieldCadence::turn(TimestampNs now) const noexcept {
  if (last_ns_ < 0.0) return now;
  const double since = (static_cast<double>(now) - last_ns_) / period_ns_;
  const double next = std::max(1.0, std::ceil(since));
  if (next - since > kGuard) return now;
  return static_cast<TimestampNs>(last_ns_ + (next + kBehind) * period_ns_);
}

Field FieldCadence::next(TimestampNs at) const noexcept {
  if (last_ns_ < 0.0) return Field::kFirst;  // whose beat becomes number 0
  const double since = (static_cast<double>(at) - last_ns_) / period_ns_;
  const std::int64_t beat = beats_ + static_cast<std::int64_t>(std::max(1.0, std::ceil(since)));
  return beat % 2 == 0 ? Field::kFirst : Field::kSecond;
}

}  // namespace dubsar
