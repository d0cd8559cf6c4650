#pragma once
// Rotations with shifts, and the small one that brings points nearer to planes.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace dubsar {

/// p to turn * p + shift.
struct RigidMotion {
  glm::dmat3 turn{1.0};
  glm::dvec3 shift{0.0};
  glm::dvec3 operator()(const glm::dvec3& p) const { return turn * p + shift; }
};

/// First b, then a.
RigidMotion after(const RigidMotion& a, const RigidMotion& b);

/// Degrees that it turns by.
double angle_deg(const RigidMotion& motion);

/// A point, the place of the other surface it belongs to, its normal there, and how much that counts.
struct PlanePair {
  glm::dvec3 point{0.0}, place{0.0}, normal{0.0};
  double weight = 1.0;
};

/// The motion that makes the weighted sum of squares of dot(normal, point - place) least, for small turns (Y. Chen, G.
/// Medioni: Object modelling by registration of multiple range images, 1992); turned about the middle of the points.
/// Directions that the pairs do not tell (a sphere's turns) stay as they are. The identity for fewer than six pairs.
RigidMotion motion_to_planes(std::span<const PlanePair> pairs);

}  // namespace dubsar
