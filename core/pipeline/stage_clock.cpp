#include "core/pipeline/stage_clock.h"

#include <algorithm>

#include "core/base/result.h"

namespace dubsar {

void StageClock::start(std::string_view name, std::string_view unit) {
  reset_peak_rss();
  current_ = StageRecord{std::string(name), 0.0, 0.0, 0.0, 0, std::string(unit)};
  started_ns_ = now();
  started_cpu_s_ = process_cpu_seconds();
}

void StageClock::finish(std::int64_t work) {
  current_.wall_s = 1e-9 * static_cast<double>(now() - started_ns_);
  current_.cpu_s = process_cpu_seconds() - started_cpu_s_;
  current_.peak_rss_mib = peak_rss_mib();
  current_.work = work;
  records_.push_back(current_);
}

void StageClock::split_before_last(std::string_view name, double wall_s, double cpu_s, std::int64_t work,
                                   std::string_view unit) {
  DUBSAR_CHECK(!records_.empty());
  StageRecord& last = records_.back();
  StageRecord record{std::string(name), wall_s, cpu_s, last.peak_rss_mib, work, std::string(unit)};
  last.wall_s = std::max(0.0, last.wall_s - wall_s);
  last.cpu_s = std::max(0.0, last.cpu_s - cpu_s);
  records_.insert(records_.end() - 1, std::move(record));
}

}  // namespace dubsar
