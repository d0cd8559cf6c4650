#include "app/viewer/input_log.h"

#include <utility>

#include "app/viewer/session_keys.h"
#include "input/input_recording.h"

namespace dubsar::app {

void InputLog::record(bool wanted) {
  const std::scoped_lock lock(mutex_);
  record_ = wanted;
}

void InputLog::hear(TimestampNs at, const InputFrame& frame) {
  const std::scoped_lock lock(mutex_);
  for (const InputEvent& event : frame.events)
    if (event.kind == EventKind::kKey && event.down && session_command(event.key)) keys_.push_back(event.key);
  if (!record_) return;
  std::string line = record_line({0, frame});  // most polls bring nothing new
  if (line != last_line_) recording_ += record_line({at, frame}) + "\n";
  last_line_ = std::move(line);
}

std::vector<std::string> InputLog::take_keys() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(keys_, {});
}

std::string InputLog::recording() const {
  const std::scoped_lock lock(mutex_);
  return recording_;
}

}  // namespace dubsar::app
