#include "core/base/system/utc_day.h"

#include <fmt/format.h>

namespace dubsar {

std::string utc_day(std::time_t time) {
  std::tm day{};
  ::gmtime_r(&time, &day);
  return fmt::format("{:04}-{:02}-{:02}", day.tm_year + 1900, day.tm_mon + 1, day.tm_mday);
}

}  // namespace dubsar
