#pragma once
// The ball on the stage that shows where the light stands, while it moves.

#include <glm/vec3.hpp>

#include "app/document/camera_pose.h"

namespace dubsar::app {

inline constexpr double kLowestLightDeg = 5.0, kHighestLightDeg = 85.0;  ///< above the panel, as far as the ball goes

/// Draws it into the current Dear ImGui frame; its lower right corner stands at `right`, `bottom`.
void draw_light_ball(const LightPlace& light, float right, float bottom);

/// The light that stands over a place of a ball of radius 1, seen from the front, x to the right, y up; places beyond
/// its rim are on it. Elevations are held between 5 and 85 degrees.
LightPlace light_over(double x, double y) noexcept;

/// Where on a ball of radius 1 that light stands: x to the right, y up, z to who looks.
glm::dvec3 place_over(const LightPlace& light);

}  // namespace dubsar::app
