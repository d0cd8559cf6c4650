#pragma once
// The day of the calendar, for names of files and for what people made.

#include <ctime>
#include <string>

namespace dubsar {

/// "2026-11-27": the day of a time, UTC. Any thread.
std::string utc_day(std::time_t time);

}  // namespace dubsar
