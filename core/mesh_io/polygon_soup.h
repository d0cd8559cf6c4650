#pragma once
// Polygons of foreign files, and how they become triangles.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct PolygonSoup {
  std::vector<std::uint32_t> corners;   ///< vertex ids of all polygons, one after the other
  std::vector<std::uint32_t> sizes;     ///< corners of each polygon, at least 3
  std::vector<PartitionId> partitions;  ///< of each polygon, or empty
};

/// Non-convex polygons with more corners than this are refused: ear clipping takes cubic time.
inline constexpr std::size_t kMaxConcaveCorners = 128;

/// Triangles keep as they are, convex polygons become fans, others are cut by ear clipping in their mean plane. All ids
/// must be valid. `what` names the file format in the error text.
Result<std::vector<Triangle>> triangulate_soup(std::span<const glm::vec3> positions, const PolygonSoup& soup,
                                               std::string_view what);

/// The partition of each triangle that triangulate_soup() makes; empty where the polygons have none.
std::vector<PartitionId> triangle_partitions(const PolygonSoup& soup);

}  // namespace dubsar
