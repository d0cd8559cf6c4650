#pragma once
// A triangle mesh with what dubsar knows about each vertex. Exporters, the renderer and the importers of foreign
// meshes all speak this type.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/volume/volume.h"

namespace dubsar {

using Triangle = std::array<std::uint32_t, 3>;  ///< counter-clockwise seen from the air

/// One labelled piece of surface. Partitions that bound the same body share a part: "envelope outside" and "envelope
/// inside" are two partitions of the part "envelope". Figures are those of the partition's own surface with its fill
/// patches, so a cavity wall such as "envelope inside" has a negative volume and the partitions of a part add up.
struct Partition {
  int id = 0;        ///< 0..7
  std::string name;  ///< "tablet", "envelope outside", "envelope inside", "object", "fragment 1", "pores", ...
  std::string part;  ///< "tablet", "envelope", ...; empty: the partition is a part of its own
  double area_mm2 = 0.0;
  double volume_mm3 = 0.0;  ///< signed volume enclosed; meaningful when watertight
  bool watertight = false;
};

/// Per-vertex arrays are either empty (not known) or have one entry per vertex.
struct TriMesh {
  std::vector<glm::vec3> positions;  ///< grid coordinates of `frame`
  std::vector<Triangle> triangles;
  std::vector<glm::vec3> normals;                   ///< unit, towards the air
  std::vector<float> k_min, k_max;                  ///< principal curvatures per grid step, k_min <= k_max, convex > 0
  std::vector<std::uint8_t> shape;                  ///< 0 flat, 1 + 9 i + s (shape_class.h)
  std::vector<std::uint8_t> partition;              ///< partition id 0..7
  std::vector<std::uint8_t> ao;                     ///< ambient light, 0 (dark) .. 63 (open)
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< only from foreign files that carry colours
  GridFrame frame;
  std::vector<Partition> partitions;
  std::string provenance;  ///< JSON text: program, version, parameters, input
};

}  // namespace dubsar
