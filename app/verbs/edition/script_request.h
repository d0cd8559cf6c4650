#pragma once
// What the verbs that find wedges have in common: the surface, its unit, the part.

#include <string>

#include "app/cli/arguments.h"
#include "app/cli/mesh_input.h"
#include "core/script/find_wedges.h"

namespace dubsar::app {

struct ScriptRequest {
  std::string in, out, unit, part = "auto";
  double width_mm = 0.0, confidence = 0.5;
};

void add_script_options(Arguments& command, ScriptRequest& request);

/// Whether a surface read from `in` can be measured in mm: kUsage for an EXA file that does not know its voxels; of
/// other files that say no unit a warning, they are taken as millimetres.
Result<void> expect_units(const TriMesh& mesh, const std::string& in);

/// The surface of a request and its wedges. Errors: those of reading, and kUsage where an EXA file has no voxel size.
struct ScriptSurface {
  TriMesh mesh;
  WedgesFound found;
};
Result<ScriptSurface> read_script(const ScriptRequest& request, Progress& progress);

}  // namespace dubsar::app
