#pragma once
// What happens when a tracker falls silent: fresh, stale (held), easing to the centre, off (trust figures: 100 ms,
// 500 ms, 3 s). VALID and TRACKED are kept apart: a held pose is valid, but not tracked.

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "core/base/system/clock.h"

namespace dubsar {

enum class Presence {
  kTracked,  ///< newest sample is at most 100 ms old
  kHeld,     ///< older: the last position stays
  kEasing,   ///< older than 500 ms: moves to the resting place
  kOff,      ///< older than 3 s, or nothing was ever seen
};

struct PresenceOptions {
  TimestampNs stale_ns = 100'000'000;
  TimestampNs hold_ns = 500'000'000;
  TimestampNs ease_ns = 1'000'000'000;  ///< duration of the move to the resting place
  TimestampNs off_ns = 3'000'000'000;
};

struct PresentPosition {
  glm::dvec3 position_m{0.0};
  Presence presence = Presence::kOff;
  double away = 1.0;  ///< how much of the way to the resting place is done, 0..1
  bool valid() const noexcept { return presence != Presence::kOff; }
  bool tracked() const noexcept { return presence == Presence::kTracked; }
};

/// From 0 to 1 as t goes from 0 to 1, at rest at both ends.
inline double smooth_step(double t) noexcept {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// The position to use for a sample of age `age_ns` (negative: never seen). No jumps: easing is a smooth step that
/// starts and ends at rest.
inline PresentPosition present_position(const glm::dvec3& last_m, const glm::dvec3& rest_m, TimestampNs age_ns,
                                        const PresenceOptions& options = {}) noexcept {
  if (age_ns < 0 || age_ns >= options.off_ns) return {rest_m, Presence::kOff, 1.0};
  if (age_ns <= options.stale_ns) return {last_m, Presence::kTracked, 0.0};
  if (age_ns <= options.hold_ns) return {last_m, Presence::kHeld, 0.0};
  const double away = smooth_step(static_cast<double>(age_ns - options.hold_ns) / static_cast<double>(options.ease_ns));
  return {glm::mix(last_m, rest_m, away), Presence::kEasing, away};
}

}  // namespace dubsar
