#include "core/compare/rigid_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace dubsar {
namespace {

using Six = std::array<double, 6>;

/// Cholesky with a ridge: what the pairs do not tell comes out as 0.
Six solve_six(std::array<Six, 6> a, Six b) {
  double trace = 0.0;
  for (std::size_t i = 0; i < 6; ++i) trace += a[i][i];
  for (std::size_t i = 0; i < 6; ++i) a[i][i] += 1e-9 * trace + 1e-300;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / a[j][j];
    }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = 6; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

/// Rodrigues.
glm::dmat3 turn_by(const glm::dvec3& rotation) {
  const double angle = glm::length(rotation);
  if (!(angle > 0)) return glm::dmat3(1.0);
  const glm::dvec3 u = rotation / angle;
  const double c = std::cos(angle), s = std::sin(angle), v = 1.0 - c;
  return {{c + u.x * u.x * v, u.y * u.x * v + u.z * s, u.z * u.x * v - u.y * s},
          {u.x * u.y * v - u.z * s, c + u.y * u.y * v, u.z * u.y * v + u.x * s},
          {u.x * u.z * v + u.y * s, u.y * u.z * v - u.x * s, c + u.z * u.z * v}};
}

}  // namespace

RigidMotion after(const RigidMotion& a, const RigidMotion& b) { return {a.turn * b.turn, a(b.shift)}; }

double angle_deg(const RigidMotion& motion) {
  const double trace = motion.turn[0][0] + motion.turn[1][1] + motion.turn[2][2];
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

RigidMotion motion_to_planes(std::span<const PlanePair> pairs) {
  if (pairs.size() < 6) return {};
  glm::dvec3 middle(0.0);
  for (const PlanePair& pair : pairs) middle += pair.point;
  middle /= static_cast<double>(pairs.size());
  double size = 0.0;  // so that turns and shifts weigh alike in the ridge
  for (const PlanePair& pair : pairs) size += glm::length(pair.point - middle);
  size = std::max(size / static_cast<double>(pairs.size()), 1e-12);
  std::array<Six, 6> normal{};
  Six right{};
  for (const PlanePair& pair : pairs) {
    const glm::dvec3 moment = glm::cross((pair.point - middle) / size, pair.normal);
    const Six row{moment.x, moment.y, moment.z, pair.normal.x, pair.normal.y, pair.normal.z};
    const double gap = glm::dot(pair.normal, pair.place - pair.point);
    for (std::size_t i = 0; i < 6; ++i) {
      right[i] += pair.weight * row[i] * gap;
      for (std::size_t j = 0; j < 6; ++j) normal[i][j] += pair.weight * row[i] * row[j];
    }
  }
  const Six x = solve_six(normal, right);
  const glm::dmat3 turn = turn_by(glm::dvec3(x[0], x[1], x[2]) / size);
  return {turn, middle - turn * middle + glm::dvec3(x[3], x[4], x[5])};
}

}  // namespace dubsar
