#pragma once
// A drawing without crossings whose points are moved as somebody likes, and then taken back where polygons cross: to
// their safe places, until none do.

#include <vector>

#include "core/extract/labelled/safe_drawing.h"

namespace dubsar {

struct TakenBack {
  int rounds = 0;           ///< in which something was taken back
  std::int64_t points = 0;  ///< that were, of vertices and added ones
  std::int64_t left = 0;    ///< pairs that touch; 0 where the drawing has none
};

/// The points that a drawing has added follow its vertices: each moves as those at its triangles do on average.
/// `moved`: places of the vertices; those of the added points are appended.
std::vector<ExactPlace> follow_vertices(const SafeDrawing& safe, std::vector<ExactPlace> moved);

/// Takes all points of x-quads that touch others, or have a triangle without area, back to their safe places, until
/// none does. Two polygons that are back cannot touch, so it ends, whatever the moves were (docs/manifold.md).
TakenBack take_back(const SafeDrawing& safe, std::vector<ExactPlace>& places);

}  // namespace dubsar
