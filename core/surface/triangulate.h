#pragma once
// X-quads to triangles such that every edge stays simple, whatever the input (algorithms.md section 1.2): 4-gons take
// either diagonal, 5- and 6-gons only diagonals between opposite corners, adjacent doubled corners a Steiner vertex.

#include <span>

#include "core/surface/quad_mesh.h"
#include "core/surface/tri_mesh.h"

namespace dubsar {

struct Triangulation {
  std::vector<Triangle> triangles;            ///< vertex ids; id >= mesh.vertex_count(): steiner[id - vertex_count()]
  std::vector<std::uint32_t> first_triangle;  ///< of quad q: triangles [first_triangle[q], first_triangle[q + 1])
  std::vector<glm::vec3> steiner;             ///< mean of the polygon's vertices
};

/// `vertex_normals` guide the diagonal (one per dual vertex, unit) or are empty: then face geometry decides.
/// Deterministic for any thread count.
Triangulation triangulate(const QuadMesh& mesh, std::span<const glm::vec3> vertex_normals);

}  // namespace dubsar
