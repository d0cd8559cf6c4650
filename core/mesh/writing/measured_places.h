#pragma once
// A surface as what is looked for on its sides needs it: places in mm, and the triangles that were measured.

#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Of each vertex, mm in the frame of the scan.
inline std::vector<glm::dvec3> places_mm(const TriMesh& mesh) {
  std::vector<glm::dvec3> places;
  places.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) places.push_back(mesh.frame.mm_from_grid(glm::dvec3(p)));
  return places;
}

/// All but what is inferred.
inline std::vector<Triangle> measured_triangles(const TriMesh& mesh) {
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.triangle_inferred.empty() || mesh.triangle_inferred[t] == 0) triangles.push_back(mesh.triangles[t]);
  return triangles;
}

}  // namespace dubsar
