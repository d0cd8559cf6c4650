#pragma once
// Progress as people and programs read it on stderr.

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "app/cli/console.h"
#include "app/cli/overall_progress.h"
#include "core/base/progress.h"

namespace dubsar::app {

struct ProgressLine {
  std::string doing;               ///< "smoothing"
  std::optional<double> fraction;  ///< 0..1; none: nobody knows how much there is
  double elapsed_s = 0.0;
  std::optional<double> remaining_s;
};

/// One line of less than `columns` characters: what is done, a bar where there is room, per cent, the time so far and
/// how much is left. Of what nobody knows how much it is: what is done and the time so far.
std::string progress_line(const ProgressLine& line, int columns);

/// "smoothing" for "smooth"; stages without such a word as they are.
std::string stage_in_words(std::string_view stage);

/// A line of the whole run that is drawn anew on a terminal, JSON lines for programs, or a line every ten seconds
/// elsewhere; with `verbose` there, a line for each stage. A thread of its own refreshes it at least twice a second, so
/// that a slow step is seen to be alive.
class ConsoleProgress final : public Progress {
 public:
  ConsoleProgress(const ConsoleOptions& options, std::vector<PlannedStage> plan);
  ~ConsoleProgress() override;

  /// No more lines: what was drawn on a terminal goes away, so that results can be printed.
  void close();

 protected:
  void on_begin(std::string_view stage, std::int64_t total, std::string_view unit) override;
  void on_advance(std::int64_t done) override;
  void on_end() override;

 private:
  void refresh_loop(const std::stop_token& stop);
  void print(bool finished);  ///< with mutex_ held, as all below
  void print_json(bool finished, double now);
  void finish_stage();
  ProgressLine line(double now);

  struct Stage {
    std::string name, unit;
    std::int64_t total = 0;
    double started_s = 0.0;
    bool active = false;
  };
  ProgressStyle style_;
  bool quiet_, verbose_, line_open_ = false;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  OverallProgress overall_;
  Stage stage_;
  double started_s_, said_s_;
  std::atomic<std::int64_t> done_{0};
  std::jthread refresher_;
};

}  // namespace dubsar::app
