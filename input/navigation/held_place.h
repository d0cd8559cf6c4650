#pragma once
// A place of the surface that a pointer holds: the turn that keeps it under the pointer.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "input/input_event.h"

namespace dubsar {

/// Where the surface under the pointer stands, of an event that has a place: right and up in heights of the window,
/// as if it were seen from far away. Without a lever the pointer's own place.
glm::dvec2 held_at(const InputEvent& event);

class HeldPlace {
 public:
  /// Of an event with a place and a lever; `centre` is what the object turns about, heights of the window from its
  /// middle.
  HeldPlace(const InputEvent& event, const glm::dvec2& centre);

  /// The turn (a rotation vector, screen axes) that takes it after the pointer, which moved by `by` heights of the
  /// window: about an axis in the picture's plane, so that nothing rolls, and at most 120 radians a height of the
  /// pointer's way; what is behind then catches up. The place has made it. None: the pointer has left the ball on which
  /// the place goes round, and nothing is under it any more.
  std::optional<glm::dvec3> follow(const glm::dvec2& by);

 private:
  glm::dvec3 ray_towards(const glm::dvec2& at) const;

  glm::dvec2 pointer_;
  std::optional<glm::dvec3> eye_;  // from the centre; none: far away
  glm::dvec3 at_{0.0};             // the place, from the centre
  glm::dvec2 centre_;
  bool near_ = true;  // on the half of its ball that is nearer to the eye
};

}  // namespace dubsar
