#pragma once
// Recorded sessions as text: one command a line, with the time when it is said.

#include <string>
#include <string_view>
#include <vector>

#include "app/commands/command_table.h"

namespace dubsar::app {

struct TimedCommand {
  double time_s = 0.0;
  std::string text;
  friend bool operator==(const TimedCommand&, const TimedCommand&) = default;
};

/// Lines "SECONDS COMMAND", in rising order of time; "+SECONDS" counts from the line before. Empty lines and those that
/// begin with # are passed over. kBadData, with the line, for others; whether commands exist is for their table to say.
Result<std::vector<TimedCommand>> parse_steps(std::string_view text, std::string_view source);

/// Whether all of it can be said with this table. kUsage, with the first line that cannot.
Result<void> check_steps(const std::vector<TimedCommand>& steps, const CommandTable& commands, std::string_view source);

}  // namespace dubsar::app
