#include "core/mesh/intersections.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/mesh/triangle_tree.h"

namespace dubsar {
namespace {

using Corners = std::array<glm::dvec3, 3>;

/// Six times the signed volume of a tetrahedron.
double volume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a);
}

/// On which side of the plane of a triangle points are.
class Sides {
 public:
  Sides(const Corners& triangle, const Corners& points) {
    const glm::dvec3 across = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    for (std::size_t i = 0; i < 3; ++i) side_[i] = glm::dot(across, points[i] - triangle[0]);
  }
  bool differ(std::size_t i, std::size_t j) const {
    return (side_[i] > 0.0 && side_[j] < 0.0) || (side_[i] < 0.0 && side_[j] > 0.0);
  }
  bool any_differ() const { return differ(0, 1) || differ(1, 2) || differ(2, 0); }

 private:
  std::array<double, 3> side_;
};

/// A segment whose ends are on both sides of the plane of a triangle passes through its inside.
bool passes(const glm::dvec3& from, const glm::dvec3& to, const Corners& t) {
  const double a = volume(from, to, t[0], t[1]), b = volume(from, to, t[1], t[2]), c = volume(from, to, t[2], t[0]);
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

}  // namespace

bool triangles_cross(std::span<const glm::vec3> positions, const std::array<std::uint32_t, 3>& a,
                     const std::array<std::uint32_t, 3>& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [&](std::uint32_t v) { return positions[v][axis]; };
    if (std::max({along(a[0]), along(a[1]), along(a[2])}) < std::min({along(b[0]), along(b[1]), along(b[2])}) ||
        std::max({along(b[0]), along(b[1]), along(b[2])}) < std::min({along(a[0]), along(a[1]), along(a[2])}))
      return false;
  }
  int shared = 0;
  for (const std::uint32_t v : a) shared += std::count(b.begin(), b.end(), v) != 0;
  if (shared >= 2) return false;
  const auto corners = [&](const std::array<std::uint32_t, 3>& t) {
    return Corners{glm::dvec3(positions[t[0]]), glm::dvec3(positions[t[1]]), glm::dvec3(positions[t[2]])};
  };
  const Corners ca = corners(a), cb = corners(b);
  // Both go through the plane of the other, or none goes through the other.
  const Sides of_b(ca, cb);
  if (!of_b.any_differ()) return false;
  const Sides of_a(cb, ca);
  if (!of_a.any_differ()) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if ((of_a.differ(i, next) && passes(ca[i], ca[next], cb)) || (of_b.differ(i, next) && passes(cb[i], cb[next], ca)))
      return true;
  }
  return false;
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(std::span<const glm::vec3> positions,
                                                             std::span<const std::array<std::uint32_t, 3>> triangles,
                                                             std::span<const std::uint8_t> wanted) {
  return pairs_that_cross(positions, triangles, wanted, [&](std::uint32_t a, std::uint32_t b) {
    return triangles_cross(positions, triangles[a], triangles[b]);
  });
}

}  // namespace dubsar
