#pragma once
// What each stage cost: wall time, CPU time, highest memory, work done.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/system/clock.h"

namespace dubsar {

struct StageRecord {
  std::string name;
  double wall_s = 0.0;
  double cpu_s = 0.0;         ///< user + system, all threads
  double peak_rss_mib = 0.0;  ///< highest resident size during the stage
  std::int64_t work = 0;      ///< items processed
  std::string unit;           ///< what an item is: "voxel", "vertex", "ray", "byte", ...
};

/// Collects stage records. A stage runs from start() to finish(); stages do not overlap. One thread.
class StageClock {
 public:
  /// Borrows the clock of the wall; without one, that of the machine.
  explicit StageClock(const Clock* wall = nullptr) : wall_(wall) {}
  void start(std::string_view name, std::string_view unit);
  /// Ends the present stage and records it.
  void finish(std::int64_t work);
  /// Moves `wall_s` and `cpu_s` of the last record to a new record placed before it: for stages that run interleaved,
  /// such as reading and resampling.
  void split_before_last(std::string_view name, double wall_s, double cpu_s, std::int64_t work, std::string_view unit);
  const std::vector<StageRecord>& records() const noexcept { return records_; }

 private:
  TimestampNs now() const noexcept { return wall_ != nullptr ? wall_->now() : SteadyClock().now(); }

  const Clock* wall_;
  std::vector<StageRecord> records_;
  StageRecord current_;
  TimestampNs started_ns_ = 0;
  double started_cpu_s_ = 0.0;
};

/// What a stage gets besides its input: who records its cost, and who is told of it and may stop it.
struct StageRun {
  StageClock& clock;
  Progress& progress;
};

}  // namespace dubsar
