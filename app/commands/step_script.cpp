#include "app/commands/step_script.h"

#include <algorithm>
#include <charconv>

namespace dubsar::app {
namespace {

constexpr double kLongestS = 86400.0;
constexpr std::size_t kMostSteps = 100'000;

}  // namespace

Result<std::vector<TimedCommand>> parse_steps(std::string_view text, std::string_view source) {
  std::vector<TimedCommand> out;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    if (line.empty() || line[0] == '#') continue;
    const double before = out.empty() ? 0.0 : out.back().time_s;
    const bool later = line[0] == '+';
    if (later) line.remove_prefix(1);
    TimedCommand step;
    const auto read = std::from_chars(line.data(), line.data() + line.size(), step.time_s);
    const auto rest = static_cast<std::size_t>(read.ptr - line.data());
    if (later) step.time_s += before;
    if (read.ec != std::errc() || rest >= line.size() || line[rest] != ' ' || !(step.time_s >= before) ||
        !(step.time_s <= kLongestS))
      return fail(ErrorKind::kBadData, "{}: line {}: \"{}\" found, expected SECONDS COMMAND, not before {} s", source,
                  number, line.substr(0, 80), before);
    line.remove_prefix(rest);
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    step.text = line;
    out.push_back(std::move(step));
    if (out.size() > kMostSteps)
      return fail(ErrorKind::kBadData, "{}: more than {} commands found", source, kMostSteps);
  }
  return out;
}

Result<void> check_steps(const std::vector<TimedCommand>& steps, const CommandTable& commands,
                         std::string_view source) {
  for (const TimedCommand& step : steps)
    if (const auto fits = commands.check(step.text); !fits)
      return fail(ErrorKind::kUsage, "{}: at {} s: {}", source, step.time_s, fits.error().message);
  return {};
}

}  // namespace dubsar::app
