#include "app/kiosk/kiosk_report.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/text/json_text.h"
#include "core/base/text/plain_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr std::size_t kLongestLine = 65'536, kClockAt = 11, kClock = 5;  // of 2026-11-27T14:05:09+0100

std::string text_of(const json& line, const char* name) {
  return line.contains(name) && line.at(name).is_string() ? plain_text(line.at(name).get<std::string>())
                                                          : std::string();
}

std::int64_t count_of(const json& line, const char* name) {
  return line.contains(name) && line.at(name).is_number_integer() ? line.at(name).get<std::int64_t>() : 0;
}

/// A trouble and how often it came.
struct Said {
  std::string from, until, what;
  int times = 1;
};

/// What the lines of one day add up to.
struct Day {
  std::string name, first, last;
  int visits = 0, resets = 0, tours = 0, broken = 0;
  std::int64_t turned = 0, opened = 0;  // as the hours say
  std::vector<Said> said;
  bool runs = false;  // it began and has not ended

  void tell(const std::string& clock, std::string what, bool again = true) {
    const auto same = std::find_if(said.begin(), said.end(), [&](const Said& one) { return one.what == what; });
    if (!again || same == said.end()) {
      said.push_back({clock, clock, std::move(what)});
      return;
    }
    same->until = clock;
    ++same->times;
  }
};

void take(const json& line, Day& day, KioskReport& report) {
  const std::string time = text_of(line, "time"), what = text_of(line, "what");
  if (time.size() < kClockAt + kClock || what.empty()) {
    ++day.broken;
    return;
  }
  const std::string clock = time.substr(kClockAt, kClock);
  if (day.first.empty()) day.first = clock;
  if (what == "start") {
    const std::string version = text_of(line, "version");
    if (day.runs) ++report.killed;
    day.tell(
        clock,
        fmt::format(
            "it began{}{}", version.empty() ? "" : ", dubsar " + version,
            day.runs ? fmt::format("; it had not ended before: killed, or the power failed after {}", day.last) : ""),
        false);
    day.runs = true;
  } else if (what == "end") {
    day.tell(clock, "it ended", false);
    day.runs = false;
  } else if (what == "trouble") {
    day.tell(clock, text_of(line, "says"));
    ++report.troubles;
  } else if (what == "operator") {
    day.tell(clock, fmt::format("the operator chose: {}", text_of(line, "does")), false);
  } else if (what == "hour") {
    day.turned = std::max(day.turned, count_of(line, "turned"));
    day.opened = std::max(day.opened, count_of(line, "opened"));
  }
  day.visits += what == "visit";
  day.resets += what == "reset";
  day.tours += what == "tour";
  day.last = clock;
}

std::string describe(const Day& day) {
  std::string out = fmt::format("{}, {} to {}: {} visits, {} times back to the beginning, {} tours", day.name,
                                day.first, day.last, day.visits, day.resets, day.tours);
  if (day.turned > 0 || day.opened > 0)
    out += fmt::format("; up to its last full hour {} turned the object, the envelope was opened or closed {} times",
                       day.turned, day.opened);
  if (day.broken > 0) out += fmt::format("; {} lines of the journal cannot be read", day.broken);
  out += "\n";
  for (const Said& said : day.said)
    out += fmt::format("  {} {}{}\n", said.from, said.what,
                       said.times == 1 ? "" : fmt::format(" ({} times until {})", said.times, said.until));
  return out;
}

}  // namespace

Result<KioskReport> kiosk_report(const std::filesystem::path& journal, int days) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(journal, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("kiosk-") && name.ends_with(".jsonl")) files.push_back(entry.path());
  }
  if (files.empty())
    return fail(ErrorKind::kNoInput, "{}: no journal of a kiosk found, expected its folder with files such as {}",
                journal.string(), "kiosk-2026-11-27.jsonl");
  std::sort(files.begin(), files.end());
  KioskReport out;
  bool runs = false;  // over midnight
  const std::size_t first = files.size() - std::min(files.size(), static_cast<std::size_t>(std::max(days, 1)));
  for (std::size_t i = first; i < files.size(); ++i) {
    Day day;
    day.name = files[i].stem().string().substr(6);
    day.runs = runs;
    day.last = "the day before";
    std::ifstream in(files[i]);
    for (std::string line; std::getline(in, line);) {
      const auto read = line.size() > kLongestLine ? Result<json>(fail(ErrorKind::kBadData, "")) : parse_json(line, "");
      if (read && read->is_object())
        take(*read, day, out);
      else
        ++day.broken;
    }
    runs = day.runs;
    out.visits += day.visits;
    ++out.days;
    out.text += describe(day);
  }
  return out;
}

}  // namespace dubsar::app
