#pragma once
// Mouse and keyboard: a window puts plain events in, two sources take them out. No window library here.

#include <memory>
#include <mutex>
#include <vector>

#include "input/input_source.h"

namespace dubsar {

/// The one queue between a window and who takes its events, in order. Any thread. At most 4096 are kept of each kind of
/// source; neighbouring motions are joined. When it is full the oldest motion goes, else the oldest turn of the wheel,
/// step of fingers or repeat of a key, else the oldest press; releases stay, so that nothing is held for ever.
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
