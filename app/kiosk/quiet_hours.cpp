#include "app/kiosk/quiet_hours.h"

#include <algorithm>
#include <optional>

namespace dubsar::app {
namespace {

std::optional<int> minute_of(std::string_view text) {
  const auto digit = [&](std::size_t i) { return text[i] >= '0' && text[i] <= '9' ? text[i] - '0' : -1; };
  if (text.size() != 5 || text[2] != ':') return std::nullopt;
  for (const std::size_t i : {0, 1, 3, 4})
    if (digit(i) < 0) return std::nullopt;
  const int hour = 10 * digit(0) + digit(1), minute = 10 * digit(3) + digit(4);
  if (hour > 23 || minute > 59) return std::nullopt;
  return 60 * hour + minute;
}

}  // namespace

Result<QuietHours> parse_quiet_hours(std::string_view text) {
  const std::size_t dash = text.find('-');
  const auto from = minute_of(text.substr(0, dash));
  const auto to = dash == std::string_view::npos ? std::nullopt : minute_of(text.substr(dash + 1));
  if (!from || !to)
    return fail(ErrorKind::kConfig, "quiet hours \"{}\" not understood, expected such as 18:00-09:30", text);
  return QuietHours{*from, *to};
}

bool is_quiet(std::span<const QuietHours> hours, int minute_of_day) noexcept {
  return std::any_of(hours.begin(), hours.end(), [&](const QuietHours& h) {
    const bool after = minute_of_day >= h.from_min, before = minute_of_day < h.to_min;
    return h.from_min <= h.to_min ? after && before : after || before;
  });
}

}  // namespace dubsar::app
