#pragma once
// From the microseconds of a library's clock to ours, when both run at (nearly) the same rate and neither
// knows the other.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/base/system/clock.h"

namespace dubsar::leapc {

/// Keeps the last kSamples comparisons and believes the tightest. With a sample every kSampleEveryNs, clocks
/// that drift by 500 ppm are off by 1 ms at most.
class ClockMap {
 public:
  static constexpr std::size_t kSamples = 8;
  static constexpr TimestampNs kSampleEveryNs = 250'000'000;

  /// The library's clock was read between two readings of ours.
  void add(TimestampNs before, std::int64_t library_us, TimestampNs after) noexcept {
    samples_[count_++ % kSamples] = {after - before, before + (after - before) / 2 - 1000 * library_us};
    tightest_ = {std::numeric_limits<TimestampNs>::max(), 0};
    for (std::size_t i = 0; i < kSamples && i < count_; ++i)
      if (samples_[i].width < tightest_.width) tightest_ = samples_[i];
  }
  bool empty() const noexcept { return count_ == 0; }
  /// Needs one sample at least.
  TimestampNs ours(std::int64_t library_us) const noexcept { return 1000 * library_us + tightest_.offset; }

 private:
  struct Sample {
    TimestampNs width = 0, offset = 0;
  };
  std::array<Sample, kSamples> samples_{};
  Sample tightest_{};
  std::size_t count_ = 0;
};

}  // namespace dubsar::leapc
