#pragma once
// The seam between a window's events and the input room's: neither knows the other.

#include <algorithm>

#include "devices/touch/touch_sample.h"
#include "display/optics/off_axis.h"
#include "display/render/context/context_glfw.h"
#include "input/gestures/touch_pointer.h"
#include "input/input_event.h"

namespace dubsar::app {

/// `window` is the size of its drawing area, which places of the pointer are counted in.
inline InputEvent to_input_event(const WindowEvent& event, const PixelSize& window) {
  InputEvent out;
  out.time = event.time;
  switch (event.kind) {
    case WindowEvent::Kind::kMotion:
      out.kind = EventKind::kMotion;
      break;
    case WindowEvent::Kind::kButton:
      out.kind = EventKind::kButton;
      break;
    case WindowEvent::Kind::kWheel:
      out.kind = EventKind::kWheel;
      break;
    case WindowEvent::Kind::kKey:
      out.kind = EventKind::kKey;
      break;
  }
  out.motion = {event.x, event.y};
  out.button = event.button == 0 ? MouseButton::kLeft : event.button == 1 ? MouseButton::kMiddle : MouseButton::kRight;
  out.down = event.down;
  out.modifiers =
      static_cast<std::uint8_t>((event.shift ? kShift : 0) | (event.control ? kControl : 0) | (event.alt ? kAlt : 0));
  out.key = event.key;
  out.repeat = event.repeat;
  if (event.at && window.height > 0)
    out.at = glm::dvec2((*event.at)[0] - 0.5 * window.width, 0.5 * window.height - (*event.at)[1]) /
             static_cast<double>(window.height);
  return out;
}

/// A finger on the panel whose window `screen` tells of.
inline PlacedTouch to_placed_touch(const TouchContact& contact, const Screen& screen) {
  const glm::dvec2 panel(screen.width_px, screen.height_px), corner(screen.window_x, screen.window_y);
  const glm::dvec2 window(screen.window_w, screen.window_h), at = contact.at * panel - corner;
  const bool inside = window.y > 0 && at.x >= 0 && at.y >= 0 && at.x <= window.x && at.y <= window.y;
  return {contact.id, glm::dvec2(at.x - 0.5 * window.x, 0.5 * window.y - at.y) / std::max(window.y, 1.0), inside};
}

}  // namespace dubsar::app
