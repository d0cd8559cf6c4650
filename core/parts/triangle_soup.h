#pragma once
// The triangles of a surface model before they become a TriMesh: parts still share vertices, and Steiner points and
// patches have added some that have no attributes yet.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/parts/surface_model.h"

namespace dubsar {

/// Ids 0..dual are dual vertices, then Steiner points, then patch
/// vertices (one copy for each side of a patch).
struct TriangleSoup {
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> partition, group;  ///< of each triangle
  std::vector<glm::vec3> added;                ///< positions of ids from dual_count on
  std::vector<std::uint8_t> patch_evidence;    ///< of the added vertices from first_patch_vertex on (evidence.h)
  std::size_t first_patch_triangle = 0;
  std::size_t first_patch_vertex = 0;  ///< an id
};

/// One for each dual vertex: whether there two partitions meet of different `group` (of each partition id), or a patch
/// uses it. Only there can a vertex have more than one fan.
std::vector<std::uint8_t> border_vertices(const SurfaceModel& model, std::span<const std::uint8_t> group);

/// All attributes that the model has, at the added vertices (AddedValue says how). Call it before split_fans().
VertexAttributes attributes_of_added(const SurfaceModel& model, const TriangleSoup& soup);

/// Gives every fan of triangles of one group around a border vertex its own copy of it. O(n log n) at most, whatever
/// the triangles are. Copy i gets the id first_copy + i; the result holds the id that each copy stands for. kCancelled.
Result<std::vector<std::uint32_t>> split_fans(TriangleSoup& soup, const std::vector<std::uint8_t>& border,
                                              std::uint32_t first_copy, const Progress* progress);

}  // namespace dubsar
