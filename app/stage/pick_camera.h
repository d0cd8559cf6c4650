#pragma once
// How a place of the object and a place of the window belong together, seen from the middle of the eyes.

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/stage/picker.h"
#include "app/stage/stage.h"

namespace dubsar::app {

/// Whether a place of the window (heights from its middle) is where another state or another surface is shown.
inline bool other_half(const Shown& shown, const glm::dvec2& window_mm, const glm::dvec2& at) {
  if (!shown.compared) return false;
  const bool first = window_mm.y > window_mm.x ? at.y > 0.0 : at.x < 0.0;
  return first == !shown.compared->surface;
}

/// From the window's middle to that of the half that a place lies in, in heights of the window; 0 where there are none.
inline glm::dvec2 half_offset(const Shown& shown, const glm::dvec2& window_mm, const glm::dvec2& at) {
  if (!shown.compared) return {0.0, 0.0};
  if (window_mm.y > window_mm.x) return {0.0, at.y > 0.0 ? 0.25 : -0.25};
  return {(at.x < 0.0 ? -0.25 : 0.25) * window_mm.x / window_mm.y, 0.0};
}

/// Places of the window count in its heights from its middle, to the right and up.
struct PickCamera {
  glm::dmat4 screen_from_model{1.0};
  glm::dvec3 camera_mm{0.0, 0.0, 600.0};  ///< in the screen frame
  glm::dvec2 middle_mm{0.0};
  double height_mm = 200.0;

  static PickCamera of(const Stage& stage) {
    return {stage.screen_from_model(), stage.camera_mm(), stage.middle_mm(), stage.window_mm().y};
  }
  glm::dvec2 seen(const glm::dvec3& model_mm) const {
    const glm::dvec3 at(screen_from_model * glm::dvec4(model_mm, 1.0));
    const glm::dvec2 eye(camera_mm);
    return (eye + (glm::dvec2(at) - eye) * (camera_mm.z / (camera_mm.z - at.z)) - middle_mm) / height_mm;
  }
  /// In mm of the model, its direction unit.
  Ray ray(const glm::dvec2& at) const {
    const glm::dmat4 model_from_screen = glm::inverse(screen_from_model);
    const glm::dvec3 from(model_from_screen * glm::dvec4(camera_mm, 1.0)),
        to(model_from_screen * glm::dvec4(middle_mm + at * height_mm, 0.0, 1.0));
    return {from, glm::normalize(to - from)};
  }
  /// Where the camera stands, in mm of the model.
  glm::dvec3 camera_of_model() const { return ray({0.0, 0.0}).from; }
  /// What one mm of the object is on the screen, without perspective.
  double scale() const { return glm::length(glm::dvec3(screen_from_model[0])); }
};

}  // namespace dubsar::app
