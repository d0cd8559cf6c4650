#pragma once
// When a kiosk rests: hours of the day, by the clock on the wall.

#include <span>
#include <string_view>

#include "core/base/result.h"

namespace dubsar::app {

/// From one minute of the day to another; over midnight when the second is the smaller one. Both the same: never.
struct QuietHours {
  int from_min = 0, to_min = 0;  ///< 0..1439
  friend bool operator==(const QuietHours&, const QuietHours&) = default;
};

/// "18:00-09:30". kConfig for anything else.
Result<QuietHours> parse_quiet_hours(std::string_view text);

/// Whether the minute of the day (0..1439) lies in one of them; their first minute does, their last does not.
bool is_quiet(std::span<const QuietHours> hours, int minute_of_day) noexcept;

}  // namespace dubsar::app
