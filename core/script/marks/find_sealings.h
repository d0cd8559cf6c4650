#pragma once
// Sealings: areas of a side that a seal was rolled over.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"
#include "core/script/text_sides.h"
#include "core/script/wedge.h"

namespace dubsar {

struct ScriptSealing {
  TextSide side = TextSide::kObverse;
  std::vector<glm::dvec3> outline_mm;  ///< closed, on the surface, counterclockwise as the side is seen
  double relief_mm = 0.0;              ///< that its figures stand out, in the median of their places
  friend bool operator==(const ScriptSealing&, const ScriptSealing&) = default;
};

/// On each side: areas at least 8 mm broad and 150 mm2 large in which figures stand out that are 1 to 4 mm broad, with
/// up to 12 mm between them, on less than .45 of the places: by .11 mm in the median, and .07 mm or four deviations of
/// the noise everywhere. `wedges`: those of the surface, around which nothing is told, nor around pits as deep;
/// inferred triangles do not take part. Deterministic. Cost: some tenths of a second.
std::vector<ScriptSealing> find_sealings(const TriMesh& mesh, const TextSides& sides,
                                         std::span<const ScriptWedge> wedges);

}  // namespace dubsar
