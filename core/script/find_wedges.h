#pragma once
// Wedges of a surface, found by their shape.

#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/script/explain_relief.h"
#include "core/script/text_sides.h"
#include "core/script/wedge.h"

namespace dubsar {

struct WedgeSearch {
  double width_mm = 0.0;          ///< usual width of a head; 0: found on the surface itself
  double least_confidence = 0.5;  ///< of the wedges that are returned
};

struct WedgesFound {
  std::vector<ScriptWedge> wedges;
  WedgeScale scale;         ///< of this surface; 0 where nothing was found
  TextSides sides;          ///< how the tablet lies, and its text on each side
  std::int64_t places = 0;  ///< deep places that were looked at
};

/// Every triangle of `mesh` takes part, but for what is inferred. Sides, lines and kinds are those of arrange_text().
/// Deterministic for any number of threads. kBadData: no triangles; kCancelled.
Result<WedgesFound> find_wedges(const TriMesh& mesh, const WedgeSearch& search, Progress& progress);

}  // namespace dubsar
