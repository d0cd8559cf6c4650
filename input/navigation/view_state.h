#pragma once
// What the viewer has done to the object and its light. Navigation makes it, cameras are made from it.

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <numbers>

namespace dubsar {

/// Axes of the screen: +X right, +Y up, +Z to the viewer.
struct ViewState {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< turns the object from its front view
  double zoom = 1.0;                        ///< 1: as large as the display fits it
  glm::dvec2 pan{0.0, 0.0};                 ///< of the object's centre, in window heights
  double light_azimuth_deg = 315.0;         ///< clockwise from the upper side of the picture
  double light_elevation_deg = 25.0;        ///< above the picture plane
  double nearer = 0.0;  ///< the object's centre towards the viewer, in window heights; worn displays
};

/// Angle between two turns, 0..180 degrees.
inline double turn_between_deg(const glm::dquat& a, const glm::dquat& b) noexcept {
  const glm::dquat d = glm::conjugate(a) * b;
  return 2.0 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w)) * 180.0 / std::numbers::pi;
}

/// The turn of a rotation vector (axis times angle in radians).
inline glm::dquat turn_of(const glm::dvec3& vector_rad) noexcept {
  const double angle =
      std::sqrt(vector_rad.x * vector_rad.x + vector_rad.y * vector_rad.y + vector_rad.z * vector_rad.z);
  if (angle < 1e-12) return {1.0, 0.5 * vector_rad.x, 0.5 * vector_rad.y, 0.5 * vector_rad.z};
  const double s = std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), s * vector_rad.x, s * vector_rad.y, s * vector_rad.z};
}

/// Its inverse: axis times angle, at most pi long.
inline glm::dvec3 vector_of(glm::dquat q) noexcept {
  if (q.w < 0.0) q = -q;
  const double s = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  if (s < 1e-12) return {2.0 * q.x, 2.0 * q.y, 2.0 * q.z};
  const double factor = 2.0 * std::atan2(s, q.w) / s;
  return {factor * q.x, factor * q.y, factor * q.z};
}

}  // namespace dubsar
