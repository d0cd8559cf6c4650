#include "app/viewer/input_log.h"

#include <utility>

#include "app/viewer/session_keys.h"

namespace dubsar::app {

void InputLog::record(std::unique_ptr<InputRecorder> recorder) {
  const std::scoped_lock lock(mutex_);
  recorder_ = std::move(recorder);
}

void InputLog::hear(TimestampNs at, const InputFrame& frame) {
  const std::scoped_lock lock(mutex_);
  for (const InputEvent& event : frame.events)
    if (event.kind == EventKind::kKey && event.down && !event.repeat && session_command(event.key))
      keys_.push_back(event.key);
  if (recorder_) recorder_->add(at, frame);
}

void InputLog::hear_own(const InputEvent& event) {
  const std::scoped_lock lock(mutex_);
  if (recorder_) recorder_->add_event(event);
}

std::vector<std::string> InputLog::take_keys() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(keys_, {});
}

Result<void> InputLog::flush() {
  const std::scoped_lock lock(mutex_);
  return recorder_ ? recorder_->flush() : Result<void>();
}

Result<void> InputLog::finish() {
  const std::scoped_lock lock(mutex_);
  return recorder_ ? recorder_->finish() : Result<void>();
}

}  // namespace dubsar::app
