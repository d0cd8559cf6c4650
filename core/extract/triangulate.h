#pragma once
// X-quads to triangles such that every edge stays simple, whatever the input, and that none cross where vertices lie in
// their cells (docs/manifold.md): a diagonal in the envelope of the grid edge, else a fan from a point of that edge.

#include <optional>
#include <span>

#include "core/extract/quad_cuts.h"
#include "core/extract/quad_mesh.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct Triangulation {
  std::vector<Triangle> triangles;            ///< vertex ids; id >= mesh.vertex_count(): steiner[id - vertex_count()]
  std::vector<std::uint32_t> first_triangle;  ///< of quad q: triangles [first_triangle[q], first_triangle[q + 1])
  std::vector<glm::vec3> steiner;             ///< centres of fans by x-quad, then points on faces
  std::vector<FacePoint> face_points;         ///< rising; the last of steiner: sides of two x-quads that bend there
};

/// Where the mesh is embedded (quad_mesh.h), as find_cuts() (quad_cuts.h) says. Where that leaves a choice, and where
/// it promises nothing: `vertex_normals` guide the diagonal of 4-gons (one per dual vertex, unit) or are empty. With
/// normals: the crease follows the curvature, i.e. the diagonal is taken that lies nearer to the surface estimated from
/// normals and positions (paper section 3.3). Without: the pair of triangles that deviates least from the mean plane.
/// Either way a 4-gon that is not convex in its mean plane is cut at its reflex corner; ties: the diagonal with the
/// lowest vertex id. Where nothing is promised 5- and 6-gons take only diagonals between opposite corners, and adjacent
/// doubled corners a fan from the mean of the vertices. Deterministic for any thread count. About 100 ns a quad and
/// thread. Behind the triangles there is room for `more`. Normals guide x-quads [0, guided). `cuts`: find_cuts() of an
/// embedded mesh, where it is known.
Triangulation triangulate(const QuadMesh& mesh, std::span<const glm::vec3> vertex_normals, std::size_t more = 0,
                          std::uint32_t guided = 0xffffffffu, std::optional<QuadCuts> cuts = std::nullopt);

}  // namespace dubsar
