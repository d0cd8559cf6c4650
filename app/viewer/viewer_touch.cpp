// Fingers on a touch panel: placed on the session's window they are events like those of its pointer.

#include "app/viewer/presenter/window_input.h"
#include "app/viewer/viewer.h"

namespace dubsar::app {

/// What fingers did since the last time; true: something came of it, which waits for who steers.
bool Viewer::use_fingers(TimestampNs now) {
  const std::vector<TouchFrame> frames = steering_->take_touches();
  std::vector<InputEvent> events;
  if (!frames.empty()) {
    const Screen screen = given_.presenter.screen(given_.options.stage.screen);
    for (const TouchFrame& frame : frames) {
      std::vector<PlacedTouch> placed;
      for (const TouchContact& contact : frame.contacts) placed.push_back(to_placed_touch(contact, screen));
      tools_.fingers.update(frame.time, placed, frame.cancelled, events);
    }
  }
  tools_.fingers.advance(now, events);
  for (InputEvent& event : events) handle(std::move(event));
  return !events.empty();
}

/// The panel may have been switched off with fingers on it.
void Viewer::let_go_of_fingers() {
  std::vector<InputEvent> events;
  tools_.fingers.update(given_.clock.now(), {}, true, events);
  for (InputEvent& event : events) handle(std::move(event));
}

/// To who steers: what fingers made at once, what a window heard when its sources are asked.
void Viewer::pass_on(const InputEvent& event) {
  if (event.touched)
    steering_->put(event);
  else
    events_.push(event);
}

}  // namespace dubsar::app
