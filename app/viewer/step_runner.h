#pragma once
// The steps of a session's options: commands at their times.

#include <functional>
#include <optional>
#include <span>

#include "app/commands/step_script.h"
#include "core/base/system/clock.h"

namespace dubsar::app {

class StepRunner {
 public:
  using Obey = std::function<Result<void>(const std::string& command)>;
  /// `steps` outlive it.
  explicit StepRunner(std::span<const TimedCommand> steps) : steps_(steps) {}
  /// Says those that are due. While `opening` says that a file is being read their time stands still, but for the step
  /// that stops it: what follows is about what is being read.
  void update(TimestampNs now, const std::function<bool()>& opening, const Obey& obey);
  bool over() const noexcept { return at_ == steps_.size(); }
  /// One that could not be done.
  const std::optional<Error>& failed() const noexcept { return failed_; }
  void fail_with(const Error& why) { failed_ = why; }

 private:
  std::span<const TimedCommand> steps_;
  std::size_t at_ = 0;
  TimestampNs began_ = -1, looked_ = -1;
  std::optional<Error> failed_;
};

}  // namespace dubsar::app
