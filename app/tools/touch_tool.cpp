#include "app/tools/touch_tool.h"

#include "app/tools/window_input.h"

namespace dubsar::app {

std::vector<InputEvent> TouchTool::events(const std::vector<TouchFrame>& frames, const Screen& screen,
                                          TimestampNs now) {
  std::vector<InputEvent> out;
  for (const TouchFrame& frame : frames) {
    std::vector<PlacedTouch> placed;
    for (const TouchContact& contact : frame.contacts) placed.push_back(to_placed_touch(contact, screen));
    fingers_.update(frame.time, placed, frame.cancelled, out);
  }
  fingers_.advance(now, out);
  return out;
}

std::vector<InputEvent> TouchTool::let_go(TimestampNs now) {
  std::vector<InputEvent> out;
  fingers_.update(now, {}, true, out);
  return out;
}

}  // namespace dubsar::app
