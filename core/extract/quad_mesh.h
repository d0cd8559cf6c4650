#pragma once
// The dual mesh: one vertex per surface piece of a cell, one x-quad per active edge (paper section 3.3). An x-quad has
// four corners, the cells around the edge; where the cell is split a corner holds two vertices, so that the polygon
// has 4 to 8 sides.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// The second vertex of a corner whose cell is split there; it follows the first in the polygon.
struct DoubledCorner {
  std::uint32_t quad = 0;
  std::uint32_t vertex = 0;
  std::uint8_t corner = 0;  ///< 0..3
  friend bool operator==(const DoubledCorner&, const DoubledCorner&) = default;
};

/// One x-quad as a polygon. vertex[0..size) runs counter-clockwise seen from the air (outside), so the right-hand
/// normal points from clay to air; corner[i] is the corner 0..3 that vertex i belongs to.
struct Polygon {
  std::array<std::uint32_t, 8> vertex;
  std::array<std::uint8_t, 8> corner;
  int size = 0;
};

/// Corner 0 is the cell at rising coordinates of both axes across the edge; the corners, and the two vertices of a
/// doubled corner, follow one another counter-clockwise seen from the air. Closed meshes have no boundary: the link of
/// every vertex is a cycle, in open ones a cycle or a path (docs/manifold.md).
struct QuadMesh {
  std::vector<glm::vec3> positions;                 ///< dual vertices in grid coordinates, order (cell z, y, x, piece)
  std::vector<std::array<std::uint32_t, 4>> quads;  ///< first vertex of each corner; order: build_quad_mesh (extract.h)
  std::vector<DoubledCorner> doubled;               ///< sorted by (quad, corner); about one in a thousand quads
  /// Vertices lie inside their cells, and triangulate() cuts x-quads so that none cross; false: of files that were
  /// written with another cut.
  bool embedded = false;

  /// Quads incident to vertex v: incident[first_incident[v] .. first_incident[v + 1]), rising.
  std::vector<std::uint32_t> first_incident;
  std::vector<std::uint32_t> incident;

  std::int64_t vertex_count() const noexcept { return static_cast<std::int64_t>(positions.size()); }
  std::int64_t quad_count() const noexcept { return static_cast<std::int64_t>(quads.size()); }
  std::span<const std::uint32_t> quads_of(std::uint32_t vertex) const noexcept {
    return std::span(incident).subspan(first_incident[vertex], first_incident[vertex + 1] - first_incident[vertex]);
  }
  /// True for quads with at least one doubled corner. Cost: one bit look-up.
  bool has_doubled(std::uint32_t quad) const noexcept { return (doubled_bits[quad >> 6] >> (quad & 63)) & 1u; }
  /// The polygon of x-quad q. O(1), O(log n) where has_doubled(q).
  Polygon polygon(std::uint32_t quad) const noexcept;

  std::vector<std::uint64_t> doubled_bits;  ///< one bit per quad

  /// Fills doubled_bits from doubled.
  void mark_doubled();
  /// Fills doubled_bits, first_incident and incident from quads and doubled (which must be sorted). All threads,
  /// deterministic; about 30 ns a quad and thread.
  void build_incidence();
};

}  // namespace dubsar
