#pragma once
// The nearest place of a surface, for many points.

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct NearPlace {
  glm::dvec3 at_mm{0.0};
  glm::dvec3 normal{0.0};  ///< unit, of the triangle; 0 where it has no area
  double distance_mm = std::numeric_limits<double>::max();
  std::uint32_t triangle = 0;
};

/// A hierarchy of boxes of triangles along a curve that fills space, eight in each. Queries from any thread.
class NearestSurface {
 public:
  /// Points in mm; triangles without a finite corner are left out.
  NearestSurface(std::vector<glm::dvec3> points_mm, std::span<const Triangle> triangles);

  bool empty() const noexcept { return order_.empty(); }
  /// Some microseconds. Of several that are as near, the first along the curve. `within_mm`: places farther than that
  /// are not looked for, and the distance stays the largest number.
  NearPlace nearest(const glm::dvec3& point, double within_mm = std::numeric_limits<double>::max()) const;

 private:
  struct Bounds {
    glm::dvec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
    double distance2(const glm::dvec3& p) const;
  };
  void look(std::size_t level, std::size_t begin, std::size_t end, const glm::dvec3& point, NearPlace& best,
            double& best2) const;

  std::vector<glm::dvec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> order_;         ///< triangles along the curve
  std::vector<std::vector<Bounds>> levels_;  ///< the lowest: of the triangles in that order
};

/// The place of a triangle that is nearest to a point (Ericson, Real-Time Collision Detection, 5.1.5).
glm::dvec3 nearest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace dubsar
