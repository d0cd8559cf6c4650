#pragma once
// How much lower than the clay above and below it each place of a side lies: where rulings are looked for.

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/mesh/writing/height_map.h"
#include "core/script/text_sides.h"
#include "core/script/wedge.h"

namespace dubsar {

/// A side as a height map, with where its corner lies: mm along right and up.
struct RuledSide {
  SideAxes axes;
  glm::dvec2 low{0.0};
  HeightMap map;
  double column_mm = 0.5;
};

/// Columns of `column_mm`, rows of the map's step: mm above (+) the mean of what lies `reach_mm` up and down, the
/// median of the side taken off; NaN where that is not known.
struct RulingMap {
  int columns = 0, rows = 0;
  double deviation_mm = 0.0;  ///< of its values, by their median distance from 0
  std::vector<float> mm;
  float at(int column, int row) const {
    return mm[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

/// `triangles` of `points_mm`: what is measured. Wedges of the side are made unknown, and what looks away from it.
RuledSide ruled_side(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles, const TextSides& sides,
                     TextSide side, std::span<const ScriptWedge> wedges, double step_mm);

/// `clip_mm`: deeper and higher counts as that.
RulingMap ruling_map(const RuledSide& side, double reach_mm, double clip_mm);

}  // namespace dubsar
