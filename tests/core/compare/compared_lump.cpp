#include "tests/core/compare/compared_lump.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace dubsar {

TriMesh lump(int rings, double phase, const RigidMotion& motion, const LumpChange& change) {
  TriMesh out;
  const int around = 2 * rings;
  const auto place = [&](double theta, double phi) {
    const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const double bumps = 1.0 + 0.03 * std::sin(3.0 * d.x + 1.0) * std::cos(2.0 * d.y) +
                         0.02 * std::sin(5.0 * d.y + 2.0 * d.z) + 0.02 * d.x * d.z + 0.015 * d.y * d.y * d.y;
    const glm::dvec3 p = bumps * glm::dvec3(22.0, 26.0, 8.0) * d;
    return motion(p + (change ? change(d) : 0.0) * glm::normalize(d / glm::dvec3(22.0, 26.0, 8.0)));
  };
  out.positions.emplace_back(place(0.0, 0.0));
  for (int r = 1; r < rings; ++r)
    for (int k = 0; k < around; ++k)
      out.positions.emplace_back(place(std::numbers::pi * r / rings, phase + 2.0 * std::numbers::pi * k / around));
  out.positions.emplace_back(place(std::numbers::pi, 0.0));
  const auto at = [&](int r, int k) {
    return static_cast<std::uint32_t>(1 + (r - 1) * around + (k + around) % around);
  };
  const auto last = static_cast<std::uint32_t>(out.positions.size() - 1);
  for (int k = 0; k < around; ++k) {
    out.triangles.push_back({0, at(1, k), at(1, k + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      out.triangles.push_back({at(r, k), at(r + 1, k), at(r + 1, k + 1)});
      out.triangles.push_back({at(r, k), at(r + 1, k + 1), at(r, k + 1)});
    }
    out.triangles.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
  }
  out.frame.input_voxel.mm = glm::dvec3(1.0);
  return out;
}

}  // namespace dubsar
