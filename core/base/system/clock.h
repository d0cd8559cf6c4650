#pragma once
// Time is an argument: whoever needs the time gets a Clock or a timestamp, and tests pass a ManualClock.

#include <atomic>
#include <cstdint>

namespace dubsar {

using TimestampNs = std::int64_t;  ///< nanoseconds of a monotonic clock

class Clock {
 public:
  virtual ~Clock() = default;
  virtual TimestampNs now() const noexcept = 0;
};

/// CLOCK_MONOTONIC. Any thread.
class SteadyClock final : public Clock {
 public:
  TimestampNs now() const noexcept override;
};

/// A clock that a test moves by hand. Any thread.
class ManualClock final : public Clock {
 public:
  explicit ManualClock(TimestampNs start = 0) : now_(start) {}
  TimestampNs now() const noexcept override { return now_.load(); }
  void advance(TimestampNs delta) { now_ += delta; }
  void set(TimestampNs now) { now_ = now; }

 private:
  std::atomic<TimestampNs> now_;
};

/// CPU seconds (user + system, all threads) used by this process so far.
double process_cpu_seconds() noexcept;

/// Highest resident set size of this process so far, in MiB (VmHWM).
double peak_rss_mib() noexcept;

/// Makes peak_rss_mib() start again from the present size where the kernel allows it (/proc/self/clear_refs);
/// false where it does not, and the peak stays that of the whole process.
bool reset_peak_rss() noexcept;

}  // namespace dubsar
