#pragma once
// Work that a window does in a thread of its own while it lives: how far it is, and how it ended.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/overall_progress.h"
#include "app/document/job_state.h"
#include "core/base/progress.h"
#include "core/base/result.h"

namespace dubsar::app {

/// One job at a time. One thread; the work itself is done in another one, owns what it works on, and leaves its result
/// where take() says that it is done.
class BackgroundJob {
 public:
  using Work = std::function<Result<void>(Progress&)>;
  BackgroundJob();
  ~BackgroundJob();  ///< asks what still works to stop, and waits for it
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;

  /// What was being done is left. With a `plan` of its stages it is said how long it will still take.
  void begin(std::string name, Work work, std::vector<PlannedStage> plan = {});
  /// Leaves what is being done; nobody hears of it again. False: nothing is.
  bool stop();
  /// How it ended, once; nothing as long as it works, or where nothing was begun.
  std::optional<Result<void>> take();
  /// Returns when take() has something, or nothing is being done.
  void wait();
  bool busy() const noexcept { return running_ != nullptr; }
  std::optional<JobState> state() const;

 private:
  class Running;
  std::unique_ptr<Running> running_;
  std::vector<std::unique_ptr<Running>> left_;  ///< until they have noticed
};

}  // namespace dubsar::app
