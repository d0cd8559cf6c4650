#pragma once
// Which triangles run along which edges.

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// One side of a triangle.
struct EdgeUse {
  std::uint32_t low = 0, high = 0;  ///< vertices
  std::uint32_t side = 0;           ///< 3 * triangle + corner that it leaves
  bool rising = false;              ///< from the lower vertex to the higher
};

/// Those of all triangles: by lower vertex, higher vertex, side. O(n) where vertices are not many more than triangles,
/// else O(n log n).
std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles);

/// The end of those that run along the same edge as `uses[begin]`.
inline std::size_t end_of_edge(std::span<const EdgeUse> uses, std::size_t begin) {
  std::size_t end = begin;
  while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) ++end;
  return end;
}

/// Of each side, 3 * triangle + corner: does no other run along its edge?
std::vector<bool> sides_alone(std::span<const Triangle> triangles);

}  // namespace dubsar
