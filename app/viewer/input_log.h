#pragma once
// What came in while pictures were made: keys that are the session's own, and the recording.

#include <mutex>
#include <string>
#include <vector>

#include "input/input_source.h"

namespace dubsar::app {

/// Any thread.
class InputLog {
 public:
  /// Whether hear() also makes a recording. Before the first hear().
  void record(bool wanted);
  /// One poll's input.
  void hear(TimestampNs at, const InputFrame& frame);
  /// The session's own keys that a script or a recording pressed since the last call; those of a window do not come
  /// this way.
  std::vector<std::string> take_keys();
  /// Lines for the `replay` source.
  std::string recording() const;

 private:
  mutable std::mutex mutex_;  // for all below
  bool record_ = false;
  std::vector<std::string> keys_;
  std::string recording_, last_line_;
};

}  // namespace dubsar::app
