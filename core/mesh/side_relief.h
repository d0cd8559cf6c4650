#pragma once
// The relief of one side of an object as a height map, and which way its impressions point.

#include <array>
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
  float at(int x, int y) const {
    return mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// `points_mm`: the vertices of `triangles`. The map has at most 1600 steps a side.
HeightMap height_map(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles, const SideAxes& side,
                     double step_mm);

/// Sums of the cubes of the slopes to the right and up, times area in mm2, after the slope of the neighbourhood (12
/// steps) was taken away; rims and edges that are steeper than the broad relief are left out. Positive to the right:
/// steep walls face left, that is, surfaces rise steeply to the right.
std::array<double, 2> slope_skew(const HeightMap& map);

/// How far the middle of the side stands above its rim, mm: of the curved sheet (a quadratic one) that touches what
/// nobody wrote on. Impressions and holes are left out. 0 where too little is known. The sheet is that of the inner
/// four fifths each way, where edges are not yet rounded.
double side_rise_mm(const HeightMap& map);

/// How much is written in the lower quarter of the side beside the rest of it, for the same area: 0 nothing, 1 as much.
/// Text ends above the lower border on the side where it ends. 1 where nothing is written at all.
double written_below(const HeightMap& map);

}  // namespace dubsar
