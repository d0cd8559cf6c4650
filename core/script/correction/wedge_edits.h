#pragma once
// What people do to wedges: draw one, move one, point at one, put them into another order.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/script/text_sides.h"
#include "core/script/wedge.h"

namespace dubsar {

/// Places that a person points at, mm on the writing surface; `normal`: of it, unit, towards the air.
struct DrawnWedge {
  std::array<glm::dvec3, 2> corner_mm{};  ///< ends of the head's edge, either first
  glm::dvec3 tail_mm{0.0}, normal{0, 0, 1};
};

/// By a person: confidence 1; side and kind as `sides` say (arrange_text.h); its deepest place is the middle of the
/// head and its depth 0 until somebody measures them. Nothing: the head has no width, or the tail no length.
std::optional<ScriptWedge> drawn_wedge(const DrawnWedge& drawn, const TextSides& sides);

/// The same wedge with the middle of its head and the end of its tail elsewhere: as broad and as deep as it was.
/// Side and kind anew; corrected, if it was found by the program. Nothing: the tail has no length.
std::optional<ScriptWedge> moved_wedge(const ScriptWedge& wedge, const glm::dvec3& head_mm, const glm::dvec3& tail_mm,
                                       const glm::dvec3& normal, const TextSides& sides);

/// From now on a person answers for it.
void correct(ScriptWedge& wedge);

/// The wedge in whose outline a place of the surface lies, or beside which it lies within a quarter of its width: the
/// nearest one, and of several the one whose deepest place is nearest.
std::optional<std::size_t> wedge_at(std::span<const ScriptWedge> wedges, const glm::dvec3& place_mm);

/// Orders from 1 as they stand; what was pressed before what is told by them, too.
void number_in_order(std::vector<ScriptWedge>& wedges);

}  // namespace dubsar
