#pragma once
// The relief of one side of an object as a height map.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// A right-handed triple: right x up = front; the side is seen from where `front` points to.
struct SideAxes {
  glm::dvec3 right, up, front;
};

/// Heights along front of what is seen first, rows from bottom to top; NaN where nothing is.
struct HeightMap {
  int width = 0, height = 0;
  double step_mm = 1.0;
  std::vector<float> mm;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  float at(int x, int y) const { return mm[index(x, y)]; }
};

/// `points_mm`: the vertices of `triangles`. The surface itself is sampled, not its vertices, so that two meshes of one
/// surface give one map.
HeightMap height_map(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles, const SideAxes& side,
                     double step_mm);

/// The map with steps of twice the size: means of two by two heights, of which three must be known.
HeightMap halved(const HeightMap& map);

}  // namespace dubsar
