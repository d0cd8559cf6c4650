#pragma once
// Large bodies are lit box by box, so that the distances that rays march through fit in memory.

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// A part of a body's box; vertices on its upper faces belong to the next.
struct LitBox {
  glm::vec3 low, high;
  bool holds(glm::vec3 p) const { return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThan(p, high)); }
};

/// Boxes that hold all of `ids`, each of at most `most_cells` with `margin` around it, unless it is as small as that.
/// They follow from the places alone.
std::vector<LitBox> lit_boxes(std::span<const glm::vec3> positions, const std::vector<std::uint32_t>& ids, float margin,
                              double most_cells);

/// The triangles that rays from a box may meet, in the order that they had.
std::vector<Triangle> triangles_near(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                                     const LitBox& box, float margin);

/// Those of `ids` that a box holds, in the order that they had.
std::vector<std::uint32_t> vertices_in(std::span<const glm::vec3> positions, const std::vector<std::uint32_t>& ids,
                                       const LitBox& box);

}  // namespace dubsar
