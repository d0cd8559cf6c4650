#pragma once
// Mouse and keyboard: a window puts plain events in, two sources take them out. No window library here.

#include <memory>
#include <mutex>
#include <vector>

#include "input/input_source.h"

namespace dubsar {

/// Events of a window, in order. Any thread. At most 4096 are kept; neighbouring motions are joined, and
/// when it is full the oldest motion goes first.
class WindowEvents {
 public:
  void push(const InputEvent& event);
  /// Takes out what a mouse (keys false) or a keyboard (keys true) made.
  std::vector<InputEvent> take(bool keys);

 private:
  std::mutex mutex_;  // for both
  std::vector<InputEvent> mouse_, keys_;
};

/// Both: kUnavailable when the configuration has no window.
Result<std::unique_ptr<InputSource>> make_mouse_source(const InputConfig& config);
Result<std::unique_ptr<InputSource>> make_keyboard_source(const InputConfig& config);

}  // namespace dubsar
