#pragma once
// How the program talks: results on stdout, everything else on stderr, and one way to be stopped.

#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "core/base/log.h"
#include "core/base/progress.h"

namespace dubsar::app {

enum class ProgressStyle { kAuto, kBar, kJson, kNone };

struct ConsoleOptions {
  ProgressStyle progress = ProgressStyle::kAuto;
  bool quiet = false;    ///< errors only
  bool verbose = false;  ///< debug messages too
};

/// True when stderr is a terminal that understands cursor movement, and NO_COLOR is not set for colours.
bool stderr_is_terminal();
bool stderr_has_colour();

/// Progress on stderr: a bar on a terminal, JSON lines for programs, or one line per finished stage elsewhere. A thread
/// of its own refreshes it at least twice a second, so that a slow step is seen to be alive.
class ConsoleProgress final : public Progress {
 public:
  explicit ConsoleProgress(const ConsoleOptions& options);
  ~ConsoleProgress() override;

 protected:
  void on_begin(std::string_view stage, std::int64_t total, std::string_view unit) override;
  void on_advance(std::int64_t done) override;
  void on_end() override;

 private:
  void refresh_loop(std::stop_token stop);
  void print_line(bool finished);  ///< with mutex_ held
  void finish_stage();             ///< with mutex_ held

  ProgressStyle style_;
  bool quiet_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::string stage_, unit_;  // guarded by mutex_
  std::int64_t total_ = 0;    // guarded by mutex_
  double started_s_ = 0.0;    // guarded by mutex_
  bool active_ = false;       // guarded by mutex_
  bool line_open_ = false;    // guarded by mutex_
  std::atomic<std::int64_t> shown_done_{0};
  std::jthread refresher_;
};

/// Installs the log handler (stderr, prefix by level, colours where allowed).
void install_log(const ConsoleOptions& options);

/// SIGINT, SIGTERM and SIGHUP cancel `progress`; the second signal ends the program at once. Call once.
void cancel_on_signals(Progress& progress);

}  // namespace dubsar::app
