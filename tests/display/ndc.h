#pragma once
// Where a view shows a place of the world.

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "display/optics/view.h"

namespace dubsar {

/// Normalised device coordinates of a place, world frame.
inline glm::dvec3 ndc(const View& view, const glm::dvec3& world) {
  const glm::dvec4 p = view.clip_from_world() * glm::dvec4(world, 1);
  return glm::dvec3(p) / p.w;
}

}  // namespace dubsar
