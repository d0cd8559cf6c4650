#pragma once
// Which field of a shutter display is due: glasses open one eye at each beat of the monitor, whether a new picture came
// or not, so fields follow the beats and not the pictures. A picture that is late skips its turn; it never swaps eyes.

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/system/clock.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// Follows the beats by the times at which presents came back; a monitor says "120 Hz" and beats 119.88 times. Presents
/// may come back up to a quarter of a beat late, never early, and pictures may miss some hundred beats; the first
/// 300 pictures are needed to find the beats. Which eye the glasses open
/// at the first beat nobody tells the program: glasses and projectors have a switch for that, and the display the
/// option right_first.
class FieldCadence {
 public:
  /// Starts anew; 60 Hz where the monitor does not say (1 to 1000 Hz are believed).
  void set_refresh(double refresh_hz) noexcept;

  /// The present call of a picture came back: a beat has just begun.
  void presented(TimestampNs at) noexcept;

  /// When to hand over a picture that is ready now: now, or behind the next beat when that is so near that nobody can
  /// say whether the picture would make it.
  TimestampNs turn(TimestampNs now) const noexcept;

  /// The field for a picture that is handed to the driver at `at`, a turn(): that of the next beat.
  Field next(TimestampNs at) const noexcept;

  double period_ns() const noexcept { return period_ns_; }

 private:
  double nominal_ns_ = 1e9 / 60.0, period_ns_ = nominal_ns_;
  struct Return {
    std::int64_t beat;
    double at_ns;
  };
  void follow() noexcept;
  const Return& earliest(std::size_t first, std::size_t count) const noexcept;

  double last_ns_ = -1.0;  ///< begin of the newest beat that is known; negative: none
  std::int64_t beats_ = 0;
  std::array<Return, 256> returns_{};  ///< the newest, in a ring
  std::size_t heard_ = 0;              ///< returns so far
};

}  // namespace dubsar
