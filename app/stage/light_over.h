#pragma once
// The light over a ball: where one points at it, and where it stands.

#include <glm/vec3.hpp>

#include "app/document/camera_pose.h"

namespace dubsar::app {

inline constexpr double kLowestLightDeg = 5.0, kHighestLightDeg = 85.0;  ///< above the panel, as far as the ball goes

/// The light that stands over a place of a ball of radius 1, seen from the front, x to the right, y up; places beyond
/// its rim are on it. Elevations are held between 5 and 85 degrees.
LightPlace light_over(double x, double y) noexcept;

/// Where on a ball of radius 1 that light stands: x to the right, y up, z to who looks.
glm::dvec3 place_over(const LightPlace& light);

}  // namespace dubsar::app
