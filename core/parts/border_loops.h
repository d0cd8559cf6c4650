#pragma once
// Borders between partitions as closed loops of vertices.

#include <cstdint>
#include <vector>

namespace dubsar {

/// A directed side of a face at a border: the face's partition is on the left.
struct BorderEdge {
  std::uint32_t from = 0, to = 0;
  std::uint32_t face = 0;  ///< on the left
  std::uint8_t left = 0;   ///< partition ids
  std::uint8_t right = 0;
  std::uint32_t beyond = 0;  ///< face on the right
};

/// Joins edges end to start into loops that visit no vertex twice, each in the sense of its edges; indices
/// into `edges`. Loops are ordered by their first edge. Edges that lead nowhere (at an open boundary) are
/// left out.
std::vector<std::vector<std::uint32_t>> join_loops(const std::vector<BorderEdge>& edges);

}  // namespace dubsar
