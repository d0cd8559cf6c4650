#pragma once
// Rulings: lines that a scribe drew across a side, shallow and nearly straight, between or below the lines of text.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"
#include "core/script/text_sides.h"
#include "core/script/wedge.h"

namespace dubsar {

struct ScriptRuling {
  TextSide side = TextSide::kObverse;
  std::vector<glm::dvec3> line_mm;  ///< on the surface, along the line of text, some mm apart
  double depth_mm = 0.0;            ///< below the clay beside it, in the median
  double clear = 0.0;               ///< its mean depth over what noise and writing make of such a line
  friend bool operator==(const ScriptRuling&, const ScriptRuling&) = default;
};

/// Along the lines of each side: grooves at least 8 mm and five usual heads long that climb by up to 3 degrees, bend by
/// up to a mm on 30, and are seen on seven tenths of their way where no wedge lies; what is less sure is left out. From
/// above in each side. `wedges`: those of the surface, whose places tell nothing; inferred triangles do not take part.
/// Deterministic. Cost: some tenths of a second.
std::vector<ScriptRuling> find_rulings(const TriMesh& mesh, const TextSides& sides,
                                       std::span<const ScriptWedge> wedges);

}  // namespace dubsar
