#include "display/sinks/field_cadence.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

constexpr double kLate = 0.25;        // of a beat: calls come back so late at most, and never early
constexpr std::size_t kOfPhase = 16;  // newest returns that tell when a beat begins
constexpr std::size_t kLeast = 64;    // returns that tell the period better than the monitor does
constexpr double kGuard = 0.25;       // of a beat, before it: too near to tell
constexpr double kBehind = 0.05;      // of a beat, after it: surely past
constexpr double kMostDetune = 0.01;  // of the period: 59.94 and 60 Hz are 0.1 % apart

}  // namespace

void FieldCadence::set_refresh(double refresh_hz) noexcept {
  nominal_ns_ = period_ns_ = 1e9 / (refresh_hz >= 1.0 && refresh_hz <= 1000.0 ? refresh_hz : 60.0);
  last_ns_ = -1.0;
  beats_ = 0;
  heard_ = 0;
}

void FieldCadence::presented(TimestampNs at) noexcept {
  const auto now = static_cast<double>(at);
  if (last_ns_ < 0.0) last_ns_ = now - period_ns_;
  beats_ += heard_ == 0
                ? 0
                : static_cast<std::int64_t>(std::max(1.0, std::round((now - last_ns_) / period_ns_ - kLate / 2.0)));
  returns_[heard_++ % returns_.size()] = {beats_, now};
  follow();
}

/// Of `count` returns from the `first` on, counted over the whole session, the one that came back soonest after its
/// beat.
const FieldCadence::Return& FieldCadence::earliest(std::size_t first, std::size_t count) const noexcept {
  const auto since_beat = [&](const Return& r) { return r.at_ns - period_ns_ * static_cast<double>(r.beat - beats_); };
  const Return* best = &returns_[first % returns_.size()];
  for (std::size_t i = first + 1; i < first + count; ++i)
    if (const Return& r = returns_[i % returns_.size()]; since_beat(r) < since_beat(*best)) best = &r;
  return *best;
}

/// The line below all returns: they are late by chance, and of many the earliest is hardly late. The slope is that from
/// the earliest of the oldest third to the earliest of the newest; how exact it is grows with the beats between them.
void FieldCadence::follow() noexcept {
  const std::size_t all = std::min(heard_, returns_.size()), third = all / 3;
  if (all >= kLeast) {
    const Return from = earliest(heard_ - all, third), to = earliest(heard_ - third, third);
    period_ns_ = std::clamp((to.at_ns - from.at_ns) / static_cast<double>(to.beat - from.beat),
                            nominal_ns_ * (1.0 - kMostDetune), nominal_ns_ * (1.0 + kMostDetune));
  }
  const std::size_t newest = std::min(heard_, kOfPhase);
  const Return& soonest = earliest(heard_ - newest, newest);
  last_ns_ = soonest.at_ns + period_ns_ * static_cast<double>(beats_ - soonest.beat);
}

TimestampNs FieldCadence::turn(TimestampNs now) const noexcept {
  if (last_ns_ < 0.0) return now;
  const double since = (static_cast<double>(now) - last_ns_) / period_ns_;
  const double next = std::max(1.0, std::ceil(since - kBehind));  // one that may just have been is waited for, too
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
