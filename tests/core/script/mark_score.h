#pragma once
// How good are cracks and sealings that were found? Beside those of a phantom. Shares no constant with the finders.

#include <span>
#include <string>

#include "core/mesh/tri_mesh.h"
#include "core/phantom/phantom.h"
#include "core/script/marks/find_cracks.h"
#include "core/script/marks/find_sealings.h"

namespace dubsar {

struct MarkScore {
  /// Vertices of a crack's walls; of those, with a drawn line within .75 mm; points of drawn lines; of those, within
  /// .75 mm of a crack.
  int wall = 0, wall_found = 0, line = 0, line_real = 0;
  int cracks = 0, cracks_false = 0;  ///< lines that were drawn; of those, with fewer than half of their points real
  /// Vertices that face their side: of whole sealings; of those, inside a drawn outline; inside drawn outlines; of
  /// those, in a band that a seal was rolled along, whole or not.
  int sealed = 0, sealed_found = 0, outlined = 0, outlined_real = 0;
  int sealings = 0, sealings_false = 0;  ///< outlines; of those, with less than half of it real
  void add(const MarkScore& other);
  std::string text() const;
};

/// `mesh`: what was looked at; `owner`: sealings and cracks are the envelope's, those of the tablet are all false.
MarkScore judge_marks(const phantom::Phantom& truth, const TriMesh& mesh, const TextSides& sides, phantom::Owner owner,
                      std::span<const ScriptCrack> cracks, std::span<const ScriptSealing> sealings);

}  // namespace dubsar
