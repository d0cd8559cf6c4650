#pragma once
// Things that happen once, as plain data: windows make them, scripts and recordings too.

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "core/base/system/clock.h"

namespace dubsar {

enum class EventKind : std::uint8_t { kMotion, kButton, kWheel, kKey, kPinch };

/// Bits; a chord is a set of them.
enum Modifier : std::uint8_t { kNoModifier = 0, kShift = 1, kControl = 2, kAlt = 4 };

enum class MouseButton : std::uint8_t { kLeft, kMiddle, kRight };

/// Height of a usual window, where only pixels or only heights of the window are known.
inline constexpr double kPixelsPerWindow = 900.0;

/// What fingers that lie on a surface did to it in its plane.
struct PinchStep {
  glm::dvec2 by{0.0};     ///< of their middle, heights of the window to the right and up
  double factor = 1.0;    ///< of their distances
  double roll_rad = 0.0;  ///< counter-clockwise
};

struct InputEvent {
  TimestampNs time = 0;
  EventKind kind = EventKind::kMotion;
  glm::dvec2 motion{
      0.0};  ///< kMotion: pixels to the right and down; kWheel: notches in .y, positive away from the user
  MouseButton button = MouseButton::kLeft;
  bool down = false;  ///< kButton, kKey; kPinch: the fingers go on, false: it was the last of them
  std::uint8_t modifiers = kNoModifier;
  std::string key{};    ///< kKey: "left", "up", "home", "space", "a", "1", "+", "f5" ...
  bool repeat = false;  ///< kKey: the keyboard says again that it is down; nobody pressed it
  /// Where the pointer is, in heights of the window from its middle, to the right and up; of kPinch where the fingers'
  /// middle is now. None: nobody knows, or a button is let go of without a click, as a finger that was none.
  std::optional<glm::dvec2> at{};
  /// kButton, kWheel, kPinch: how far the surface under the pointer stands before the object's centre, in heights of
  /// the window; none: there is no surface, or nobody looked.
  std::optional<double> lever{};
  /// With a lever: where the eye is, heights of the window from its middle, z towards the viewer; none: so far away
  /// that all it sees lies behind the pointer's place.
  std::optional<glm::dvec3> eye{};
  PinchStep pinch{};     ///< kPinch
  bool touched = false;  ///< made by fingers on a touch panel
};

}  // namespace dubsar
