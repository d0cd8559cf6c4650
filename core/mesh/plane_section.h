#pragma once
// Where a plane cuts a surface.

#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// A piece of the cut, across one triangle.
struct SectionPiece {
  glm::dvec3 a_mm{0.0}, b_mm{0.0};
  std::size_t triangle = 0;
};

/// All pieces of the cut with the plane through `at_mm` across `normal` (any length but 0), in the order of the
/// triangles; a vertex on the plane counts as beyond it, so that closed surfaces have closed cuts. One thread; some 5
/// ns a triangle.
std::vector<SectionPiece> plane_section(const TriMesh& mesh, const glm::dvec3& at_mm, const glm::dvec3& normal);

}  // namespace dubsar
