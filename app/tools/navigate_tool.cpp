#include "app/tools/navigate_tool.h"

#include <utility>

#include "app/stage/pick_camera.h"

namespace dubsar::app {

void NavigateTool::see(const InputEvent& event) {
  const bool goes_on = event.kind == EventKind::kWheel || (event.kind == EventKind::kPinch && event.down);
  if (!goes_on) wheeled_.reset();
}

/// An event at a place of the window is told where the surface under it stands and where it is seen from.
void NavigateTool::tell_depth(InputEvent& event) {
  if (!event.at || scene_.options->subject == Subject::kPattern || scene_.options->pictures) return;
  const bool wheel = event.kind == EventKind::kWheel, pinch = event.kind == EventKind::kPinch;
  std::optional<InputEvent>& same = wheeled_;
  if (same && same->kind == event.kind && (pinch || (wheel && same->at == event.at))) {
    event.lever = same->lever;
    event.eye = same->eye;
    return;
  }
  same.reset();
  const Stage& stage = *scene_.stage;
  const double height = stage.window_mm().y;
  if (const auto picked = scene_.picked_at(*event.at)) {
    event.lever = glm::dvec4(stage.screen_from_model() * glm::dvec4(picked->at_mm, 1.0)).z / height;
    event.eye = (stage.camera_mm() - glm::dvec3(stage.middle_mm(), 0.0)) / height;
  }
  if (wheel || pinch) same = event;
}

bool NavigateTool::take(InputEvent& event) {
  if (event.kind == EventKind::kKey) return false;
  const bool pressed = event.down && (event.kind == EventKind::kButton || event.kind == EventKind::kPinch);
  if (event.kind == EventKind::kWheel || pressed) tell_depth(event);
  // Who turns and zooms knows nothing of what stands beside the surface.
  if (event.at && !std::exchange(held_, event.kind == EventKind::kMotion ? held_ : pressed))
    middle_ =
        glm::dvec2(scene_.window.aside, 0.0) + half_offset(scene_.stage->shown(), scene_.stage->window_mm(), *event.at);
  if (event.at) *event.at -= middle_;
  if (event.eye) *event.eye -= glm::dvec3(middle_, 0.0);
  if (event.touched)
    steering_.put(event);
  else
    mouse_.push(event);
  return true;
}

}  // namespace dubsar::app
