#pragma once
// Cracks: long, narrow, steep gaps, deeper than they are wide, that run as they will.

#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/tri_mesh.h"
#include "core/script/text_sides.h"

namespace dubsar {

struct ScriptCrack {
  TextSide side = TextSide::kObverse;
  std::vector<glm::dvec3> line_mm;  ///< at the level of the clay beside it
  double width_mm = 0.0;            ///< in the mean
  friend bool operator==(const ScriptCrack&, const ScriptCrack&) = default;
};

/// On each side: gaps narrower than a mm (half a mm) and deeper than that, at least 4 mm and four widths long, that run
/// as they will, on clay that faces the side; a gap whose floor is not in the mesh counts. What is inferred is level
/// and hides what is below it. Deterministic. Cost: some tenths of a second.
std::vector<ScriptCrack> find_cracks(const TriMesh& mesh, const TextSides& sides);

}  // namespace dubsar
