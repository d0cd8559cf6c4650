#pragma once
// Is a triangle mesh a 2-manifold? Used by tests, reports and `dubsar info`.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct MeshCheck {
  std::int64_t vertices = 0;  ///< vertices used by triangles
  std::int64_t edges = 0;
  std::int64_t triangles = 0;
  std::int64_t boundary_edges = 0;        ///< one triangle
  std::int64_t nonmanifold_edges = 0;     ///< three or more triangles
  std::int64_t inconsistent_edges = 0;    ///< two triangles that run along it in the same direction
  std::int64_t nonmanifold_vertices = 0;  ///< link is neither one cycle nor one path
  std::int64_t degenerate_triangles = 0;  ///< two equal vertex ids
  std::int64_t zero_area_triangles = 0;   ///< distinct ids, area exactly 0 or not finite
  std::int64_t components = 0;            ///< connected by shared vertices
  std::int64_t euler = 0;                 ///< V - E + F

  bool manifold() const noexcept {
    return nonmanifold_edges + nonmanifold_vertices + inconsistent_edges + degenerate_triangles == 0;
  }
  bool watertight() const noexcept { return manifold() && boundary_edges == 0 && triangles > 0; }
};

/// Degenerate triangles are counted and otherwise left out; vertex ids must be in range (checked). All threads, O(n);
/// 12 bytes a triangle and 8 a vertex of memory; about 1 s for 5 million triangles and one thread.
MeshCheck check_mesh(std::span<const glm::vec3> positions, std::span<const Triangle> triangles);

/// For each partition id whether its triangles alone are watertight(). Partitions must not share vertices. Cost as
/// check_mesh(), once for all of them.
std::vector<bool> watertight_parts(std::size_t vertices, std::span<const Triangle> triangles,
                                   std::span<const PartitionId> parts);

}  // namespace dubsar
