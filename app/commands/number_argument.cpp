#include "app/commands/number_argument.h"

#include <charconv>

namespace dubsar::app {

Result<double> number_argument(std::string_view command, const std::string& text, double low, double high) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !(value >= low && value <= high))
    return fail(ErrorKind::kUsage, "{}: \"{}\" found, expected a number of {} to {}", command, text, low, high);
  return value;
}

}  // namespace dubsar::app
