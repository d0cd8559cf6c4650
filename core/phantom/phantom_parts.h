#pragma once
// What a phantom is made of. Lengths in voxels; all points are those of the model, turned against the grid.

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "core/phantom/cell_lists.h"
#include "core/phantom/clay_body.h"
#include "core/phantom/dual.h"
#include "core/phantom/stylus.h"

namespace dubsar::phantom {

/// How the model lies in the grid.
struct ModelPlace {
  float voxels_per_mm = 1.0f;
  Float4 origin{}, axis_x{}, axis_y{}, axis_z{};

  Point point(float x, float y, float z) const {
    Point point;
    point.p = origin + axis_x * x + axis_y * y + axis_z * z;
    return point;
  }
  glm::dvec3 grid_vector(Float4 model) const { return {dot(axis_x, model), dot(axis_y, model), dot(axis_z, model)}; }
  glm::dvec3 grid_point(Float4 model) const { return grid_vector(model - origin); }
};

struct Impression {
  WedgeField field;
  Float4 middle;
  float radius2;  ///< farther from the middle it changes nothing
};

/// Tablet or envelope, and what was written on it.
struct WrittenBody {
  ClayBody body;
  std::vector<Impression> wedges;
  CellLists cells;      ///< of the wedges
  float relief = 0.0f;  ///< no decoration or impression is farther from the smooth surface
};

/// How clay is rounded where it was pressed and where it joins.
struct ClayEdges {
  float rim_rounding = 1.0f, join_rounding = 1.0f;
  float lip_height = 0.0f, lip_width = 1.0f;  ///< of the clay that a stylus pushes up around its impression
  float hint = 0.0f;  ///< how much shallower than the wedge the envelope follows it, where it was pressed on
};

/// What lies between tablet and envelope.
struct ClayGap {
  Waves variation, glue;  ///< glue above the threshold: they are one
  float threshold = 0.0f, ramp = 1.0f, open = 1.0f, overlap = 1.0f;
  float film = 0.0f;                          ///< that is left where they touch; 0: none
  std::vector<ClayBody::FingerMark> touches;  ///< depth: share of the gap that closes

  /// Its width, negative where both are one.
  Dual width(const Point& point) const;
};

struct Pore {
  Float4 centre;
  std::array<Float4, 3> axis;  ///< unit axes divided by the radii
  float smallest;
};
struct Straw {
  Float4 a, b;
  float radius;
};
struct Grain {
  Float4 centre;
  float radius;
};

/// What is strewn through the clay.
template <class Thing>
struct Strewn {
  std::vector<Thing> all;
  CellLists cells;
};

struct Crack {  ///< a bent sheet, thinner towards its rim
  Float4 centre{}, normal{};
  float radius2 = 0.0f, half_width = 0.0f;
  Waves bend;
};

}  // namespace dubsar::phantom
