#pragma once
// Turns by degrees.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace dubsar::test {

inline constexpr double kRad = std::numbers::pi / 180.0;

inline glm::dquat about(const glm::dvec3& axis, double degrees) { return glm::angleAxis(degrees * kRad, axis); }

}  // namespace dubsar::test
