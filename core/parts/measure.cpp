#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"
#include "core/mesh/mesh_check.h"
#include "core/parts/surface_model.h"

namespace dubsar {

MeshMeasure measure_mesh(const TriMesh& mesh) {
  if (mesh.positions.empty()) return {};
  struct Sums {
    double area = 0.0, volume = 0.0;
  };
  const glm::dvec3 step_mm = mesh.frame.grid_voxel_mm();
  const glm::dvec3 origin(mesh.positions.front());  // near the surface, so that the volume does not cancel
  const auto sums = parallel_reduce<Sums>(
      static_cast<std::int64_t>(mesh.triangles.size()), 1 << 16, {},
      [&](std::int64_t begin, std::int64_t end) {
        Sums s;
        for (std::int64_t t = begin; t < end; ++t) {
          const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(t)];
          const auto corner = [&](std::size_t c) {
            return (glm::dvec3(mesh.positions[triangle[c]]) - origin) * step_mm;
          };
          const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
          s.area += 0.5 * glm::length(glm::cross(b - a, c - a));
          s.volume += glm::dot(a, glm::cross(b, c)) / 6.0;
        }
        return s;
      },
      [](Sums a, Sums b) {
        return Sums{a.area + b.area, a.volume + b.volume};
      });
  const double handedness = step_mm.x * step_mm.y * step_mm.z < 0.0 ? -1.0 : 1.0;
  return {sums.area, handedness * sums.volume, check_mesh(mesh.positions, mesh.triangles).watertight()};
}

}  // namespace dubsar
