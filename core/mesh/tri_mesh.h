#pragma once
// A triangle mesh with what dubsar knows about each vertex. Exporters, the renderer and the importers of foreign
// meshes all speak this type.

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/mesh/partition_table.h"
#include "core/volume/volume.h"

namespace dubsar {

using Triangle = std::array<std::uint32_t, 3>;  ///< counter-clockwise seen from the air

/// What may be known of the vertices of a surface besides where they are: each array is empty (not known) or has one
/// entry per vertex. vertex_attributes.h lists the members.
struct VertexAttributes {
  std::vector<glm::vec3> normals;                   ///< unit, towards the air
  std::vector<float> k_min, k_max;                  ///< principal curvatures per grid step, k_min <= k_max, convex > 0
  std::vector<std::uint8_t> shape;                  ///< 0 flat, 1 + 9 i + s (shape_class.h)
  std::vector<std::uint8_t> ao;                     ///< ambient light, 0 (dark) .. 63 (open)
  std::vector<std::uint8_t> evidence;               ///< how the place is known (evidence.h)
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< only from foreign files that carry colours
};

/// Partitions are labels of triangles: those of one body share the vertices on their border.
struct TriMesh : VertexAttributes {
  std::vector<glm::vec3> positions;  ///< grid coordinates of `frame`
  std::vector<Triangle> triangles;
  std::vector<PartitionId> triangle_partition;  ///< one per triangle; empty: all 0
  std::vector<std::uint8_t> triangle_inferred;  ///< one per triangle, 1: inferred (evidence.h); empty: none
  GridFrame frame;
  PartitionTable partitions;
  std::string provenance;  ///< JSON text: program, version, parameters, input

  PartitionId partition_of(std::size_t triangle) const noexcept {
    return triangle_partition.empty() ? PartitionId{0} : triangle_partition[triangle];
  }
};

}  // namespace dubsar
