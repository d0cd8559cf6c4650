#include "app/kiosk/kiosk_diary.h"

#include <ctime>

#include "app/words/text.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

constexpr std::size_t kTroublesShown = 3;

WallTime this_machine() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return {static_cast<std::int64_t>(now), 60 * local.tm_hour + local.tm_min};
}

}  // namespace

KioskDiary::KioskDiary(std::filesystem::path journal, std::function<WallTime()> wall)
    : journal_(std::move(journal)), wall_(wall ? std::move(wall) : this_machine) {}

void KioskDiary::write(std::string_view what, std::string_view figures) {
  const auto done = journal_.add(wall_().unix_s, what, figures);
  if (!done && done.error().message != unwritten_) log_warning("{}", done.error().message);
  unwritten_ = done ? std::string() : done.error().message;
}

void KioskDiary::trouble(std::string_view says) {
  write("trouble", Journal::words("says", says));
  const int minute = wall_().minute_of_day;
  troubles_.push_back(fmt::format("{:02}:{:02} {}", minute / 60, minute % 60, says));
  if (troubles_.size() > kTroublesShown) troubles_.erase(troubles_.begin());
}

void KioskDiary::look_at_devices(std::span<const SourceRow> sources) {
  devices_.assign(sources.begin(), sources.end());
  std::string missing;
  for (const SourceRow& row : sources)
    if (row.health == SourceHealth::kMissing || row.health == SourceHealth::kLost)
      missing += fmt::format("{}{}: {}", missing.empty() ? "" : "; ", row.spec, row.reason);
  if (missing.empty() || missing == missing_) return;
  missing_ = std::move(missing);
  trouble(missing_);
}

void KioskDiary::look_at_day(std::int64_t visits) {
  const std::int64_t now = wall_().unix_s;
  std::string day = journal_.file(now).string();
  if (day == day_) return;
  day_ = std::move(day);
  visits_before_ = visits - journal_.visits(now);
}

std::vector<std::string> KioskDiary::state() const {
  std::vector<std::string> out;
  for (const SourceRow& row : devices_)
    out.push_back(row.health == SourceHealth::kPresent ? tr("operator.works", row.spec)
                  : row.health == SourceHealth::kOff   ? tr("operator.off", row.spec)
                  : row.health == SourceHealth::kLost  ? tr("operator.lost", row.spec, row.reason)
                                                       : tr("operator.missing", row.spec, row.reason));
  out.insert(out.end(), troubles_.begin(), troubles_.end());
  if (troubles_.empty()) out.push_back(tr("operator.no_trouble"));
  return out;
}

}  // namespace dubsar::app
