#pragma once
// Plates that are formulas.

#include <cmath>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// A sheet of heights over x and y in mm; a height that is not a number is a hole.
template <class Height>
TriMesh sheet_of(double half, double step, const Height& height) {
  TriMesh mesh;
  mesh.frame.input_voxel.mm = glm::dvec3(1.0);
  mesh.frame.input_voxel.provenance = "test";
  const int n = static_cast<int>(2 * half / step);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = -half + i * step, y = -half + j * step;
      mesh.positions.push_back(glm::vec3(x, y, height(x, y)));
    }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (!std::isnan(mesh.positions[a].z + mesh.positions[b].z + mesh.positions[c].z))
      mesh.triangles.push_back({a, b, c});
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int u, int v) { return static_cast<std::uint32_t>(v * (n + 1) + u); };
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

}  // namespace dubsar
