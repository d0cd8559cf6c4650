#pragma once
// What a kiosk tells those who are not there: its journal, and for its operator how devices stand, the last troubles
// and how many came today.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/source_row.h"
#include "app/kiosk/journal.h"

namespace dubsar::app {

/// The time of the wall: seconds since 1970, and the local minute of the day.
struct WallTime {
  std::int64_t unix_s = 0;
  int minute_of_day = 0;
};

/// One thread.
class KioskDiary {
 public:
  /// As of Journal; `wall` empty: the clock of this machine.
  KioskDiary(std::filesystem::path journal, std::function<WallTime()> wall);

  WallTime wall() const { return wall_(); }
  /// A line of the journal; one that cannot be written is logged once.
  void write(std::string_view what, std::string_view figures = {});
  void trouble(std::string_view says);
  /// What is new is written down, not that the same one is away again.
  void look_at_devices(std::span<const SourceRow> sources);
  /// `visits` of this session so far; days are those of the calendar.
  void look_at_day(std::int64_t visits);
  /// Those before a restart, too.
  std::int64_t visits_today(std::int64_t visits) const noexcept { return visits - visits_before_; }
  /// A sentence for each device, and each of the last troubles.
  std::vector<std::string> state() const;

 private:
  Journal journal_;
  std::function<WallTime()> wall_;
  std::string unwritten_, missing_, day_;
  std::vector<SourceRow> devices_;
  std::vector<std::string> troubles_;
  std::int64_t visits_before_ = 0;
};

}  // namespace dubsar::app
