#pragma once
// What is on a side and is no wedge, each in a layer of its own in drawings and a list of its own in tables.

#include <span>
#include <vector>

#include "core/script/marks/find_cracks.h"
#include "core/script/marks/find_sealings.h"
#include "core/script/rulings/find_rulings.h"

namespace dubsar {

struct ScriptMarks {
  std::vector<ScriptRuling> rulings;
  std::vector<ScriptCrack> cracks;
  std::vector<ScriptSealing> sealings;
};

/// Those of all six sides. `wedges`: those of the surface. Of a surface that touches another (of one vertex in a
/// hundred the evidence is no air) rulings alone: rims of the contact stand out like figures of a seal, and gape like
/// cracks. Cost: some tenths of a second.
ScriptMarks find_marks(const TriMesh& mesh, const TextSides& sides, std::span<const ScriptWedge> wedges);

}  // namespace dubsar
