#pragma once
// Where polygons at a cell of several pieces touch although they are fans along its faces, its vertices move inside the
// cell until they do not (docs/manifold.md).

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>

#include "core/extract/quad_mesh.h"

namespace dubsar {

struct PieceMoves {
  std::int64_t touching = 0;  ///< cells where polygons touched
  std::int64_t moved = 0;     ///< vertices that moved
  std::int64_t left = 0;      ///< cells where they still do
};

/// The place next to one in its cell that a vertex may have.
using PlaceOfVertex = std::function<glm::vec3(std::uint32_t vertex, const glm::vec3& wanted)>;

/// Moves mesh.positions of an embedded mesh, few cells, one after the other: to the mean of the crossings around each
/// vertex, drawn towards the chords, or to other means in a fixed pseudo-random order, the first place at which nothing
/// around comes to touch. Where there is none, the vertices of all polygons around go back to `safe`, the places of an
/// extracted mesh, and all is tried again; then with each of them moved as those of the cell are. Deterministic. Costs
/// a find_cuts(), and about 50 us for each place tried.
PieceMoves part_pieces(QuadMesh& mesh, std::span<const glm::vec3> safe, const PlaceOfVertex& place);

}  // namespace dubsar
