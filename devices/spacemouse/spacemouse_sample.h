#pragma once
// What every six-axis 3D mouse gives, whatever its bytes look like.

#include <cstdint>
#include <glm/vec3.hpp>

#include "core/base/system/clock.h"

namespace dubsar {

/// The cap and the buttons, in the axes of the screen frame (x right, y up, z to the viewer).
struct SpaceMouseSample {
  TimestampNs time = 0;
  glm::dvec3 translation{0.0};  ///< each -1..1: share of the full deflection
  glm::dvec3 rotation{0.0};     ///< right-handed about each axis, -1..1
  std::uint64_t buttons = 0;
};

}  // namespace dubsar
