#pragma once
// What the verbs that find wedges have in common: the surface, its unit, the part.

#include <string>

#include "app/cli/arguments.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "core/script/find_wedges.h"
#include "core/script/marks/script_marks.h"

namespace dubsar::app {

struct ScriptRequest {
  std::string in, out, unit, part = "auto";
  double width_mm = 0.0, confidence = 0.5;
  std::string work;          ///< a session's file, whose wedges they are
  bool found_alone = false;  ///< whatever was kept
  KeptDocument kept{};
};

void add_script_options(Arguments& command, ScriptRequest& request);

/// Whether a surface read from `in` can be measured in mm: kUsage for an EXA file that does not know its voxels; of
/// other files that say no unit a warning, they are taken as millimetres.
Result<void> expect_units(const TriMesh& mesh, const std::string& in);

/// "82 wedges, kept in a session: 80 found by the program, 2 by people"; empty where they were found now.
std::string kept_words(const std::vector<ScriptWedge>& wedges);

/// The surface of a request, its marks (rulings, cracks, seals), and its wedges: those that a session kept of the part,
/// else found. Errors: those of reading, and kUsage where an EXA file has no voxel size.
struct ScriptSurface {
  TriMesh mesh;
  WedgesFound found;
  ScriptMarks marks;
  bool kept = false;  ///< the wedges are those of a session
};
Result<ScriptSurface> read_script(const ScriptRequest& request, Progress& progress);

}  // namespace dubsar::app
