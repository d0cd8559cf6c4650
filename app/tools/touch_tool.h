#pragma once
// Fingers on touch panels: placed on the session's window they are events like those of its pointer.

#include <vector>

#include "display/optics/off_axis.h"
#include "input/gestures/touch_pointer.h"
#include "input/input_source.h"

namespace dubsar::app {

/// One thread: that of the session.
class TouchTool {
 public:
  /// What fingers did up to `now`, in its order. `screen` is that of the session's window.
  std::vector<InputEvent> events(const std::vector<TouchFrame>& frames, const Screen& screen, TimestampNs now);
  /// The panel may have been switched off with fingers on it.
  std::vector<InputEvent> let_go(TimestampNs now);

 private:
  TouchPointer fingers_;
};

}  // namespace dubsar::app
