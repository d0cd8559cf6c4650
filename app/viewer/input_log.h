#pragma once
// What came in while pictures were made: keys that are the session's own, and the recording.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "input/input_recorder.h"

namespace dubsar::app {

/// Any thread.
class InputLog {
 public:
  /// What hear() writes to from now on.
  void record(std::unique_ptr<InputRecorder> recorder);
  /// One poll's input.
  void hear(TimestampNs at, const InputFrame& frame);
  /// What the session took from its window before any source saw it.
  void hear_own(const InputEvent& event);
  /// The session's own keys that a script or a recording pressed since the last call; those of a window do not come
  /// this way.
  std::vector<std::string> take_keys();
  /// Waits until the recording is in its file: for sessions that are faster than real time.
  Result<void> flush();
  /// Ends the recording; the first error that there was.
  Result<void> finish();

 private:
  mutable std::mutex mutex_;  // for all below
  std::unique_ptr<InputRecorder> recorder_;
  std::vector<std::string> keys_;
};

}  // namespace dubsar::app
