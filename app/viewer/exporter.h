#pragma once
// What is published of the surface that is shown, written by this program itself in a process of its own, while the
// window lives.

#include <memory>
#include <optional>
#include <string>

#include "app/commands/export_words.h"
#include "app/session/background_job.h"

namespace dubsar::app {

/// One thread: that of the session.
class Exporter {
 public:
  /// What is written, of what, and how; `program`: of ours, empty: the one that runs.
  struct Order {
    std::string kind, surface, out, side, program{};
  };
  /// Begins; what was being written before is left. `out` empty: beside the surface, NAME_plate.tif and the like; of
  /// keyframes without ffmpeg give a folder. kUsage: no kind, or no file of a surface; kUnavailable: the program that
  /// runs is another one, which has this one in it.
  Result<void> begin(const Order& order, const ExportChoice& choice, const Document& document);
  bool stop() { return job_.stop(); }
  std::optional<JobState> state() const { return job_.state(); }
  void wait() { job_.wait(); }
  /// What is to be said of how it ended, once.
  std::optional<std::string> ended();

 private:
  BackgroundJob job_;
  std::string out_;
};

}  // namespace dubsar::app
