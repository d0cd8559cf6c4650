#pragma once
// Where the triangles of an x-quad may lie so that they cross those of no other: in the four tetrahedra between its
// grid edge and its sides (docs/manifold.md). In integers, from the places of its vertices alone.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/mesh/exact_triangles.h"

namespace dubsar {

/// The grid edge of an x-quad: from `low` one step along `axis`.
struct QuadEdge {
  ExactPlace low{0};
  int axis = 0;
  bool strict = false;  ///< the vertices lie inside their cells, none on a wall
  bool flat = false;    ///< of a cap: all vertices lie at `low` along the axis
};

/// The grid edge around which vertices lie, given the first vertex of each corner, corner 0 in the cell at rising
/// coordinates: each in its own of the four cells around the edge, walls included. Nothing where there is none.
std::optional<QuadEdge> edge_of_quad(const std::array<ExactPlace, 4>& corner) noexcept;

/// Which diagonals leave both triangles in the envelope: bit 0 that between corners 0 and 2, bit 1 that between 1
/// and 3. Neither makes a triangle without area. In a cap: which leave both triangles on the same side.
unsigned allowed_diagonals(const std::array<ExactPlace, 4>& corner, const QuadEdge& edge) noexcept;

/// The same for vertices that all lie inside their cells, away from walls; nothing where one does not. About 20 ns.
std::optional<unsigned> allowed_inside(const std::array<ExactPlace, 4>& corner) noexcept;

/// The point of the edge that a fan of these vertices runs from: as high as they are in the mean, the nearest place,
/// halves up; of a cap the grid point. `vertices`: those of the polygon.
ExactPlace point_on_edge(std::span<const ExactPlace> vertices, const QuadEdge& edge) noexcept;

}  // namespace dubsar
