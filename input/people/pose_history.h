#pragma once
// Recent positions of a tracked point with their device times, and where it will be when the frame is seen.

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

#include "core/base/system/clock.h"

namespace dubsar {

struct PositionSample {
  TimestampNs time = 0;  ///< when the device measured it
  glm::dvec3 position_m{0.0};
};

/// Keeps the last 64 samples. Velocity is the slope of a least-squares line over `window_ns`, which is best for slow
/// and medium head speeds (Bailer et al. 2015). Of slow trackers the window is longer: 3.5 times the median of the last
/// seven steps between samples, so that four samples lie in it, and three where one was lost, at most 300 ms: a tracker
/// of 30 Hz has two in 60 ms, which is no line. One thread.
class PositionHistory {
 public:
  explicit PositionHistory(TimestampNs window_ns = 100'000'000) : window_ns_(window_ns) {}

  /// Samples must rise in time; older or equal ones are dropped and counted.
  bool add(const PositionSample& sample) noexcept;
  void clear() noexcept { count_ = 0; }
  bool empty() const noexcept { return count_ == 0; }
  const PositionSample& newest() const noexcept { return samples_[(next_ + kCapacity - 1) % kCapacity]; }
  std::size_t dropped() const noexcept { return dropped_; }

  /// m/s from the samples of the window; 0 with fewer than three samples or less than 10 ms.
  glm::dvec3 velocity_mps() const noexcept;

  /// Position expected at `time`: the fitted line, at most `max_ahead_ns` beyond the newest sample. Nothing when empty.
  std::optional<glm::dvec3> predict(TimestampNs time, TimestampNs max_ahead_ns = 100'000'000) const noexcept;

 private:
  static constexpr std::size_t kCapacity = 64;
  struct Line {
    glm::dvec3 at_newest_m, velocity_mps;
  };
  std::optional<Line> fit() const noexcept;
  const PositionSample& ago(std::size_t i) const noexcept {
    return samples_[(next_ + 2 * kCapacity - 1 - i) % kCapacity];
  }
  TimestampNs window() const noexcept;

  TimestampNs window_ns_;
  std::array<PositionSample, kCapacity> samples_{};
  std::size_t next_ = 0, count_ = 0, dropped_ = 0;
};

}  // namespace dubsar
