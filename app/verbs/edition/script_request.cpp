#include "app/verbs/edition/script_request.h"

#include <fmt/format.h>

#include "core/base/system/log.h"

namespace dubsar::app {

void add_script_options(Arguments& command, ScriptRequest& request) {
  command.reads("IN", request.in, "EXA, PLY, OBJ, STL or GLB file").required();
  command.value("--part", request.part, "which part: tablet where there is one (auto), all, envelope outside, ...");
  command.value("--unit", request.unit, kUnitHelp);
  command
      .value("--width", request.width_mm, "usual width of a head in mm, where the one found (see the result) is wrong")
      .not_negative();
  command.value("--confidence", request.confidence, "least confidence of a wedge, 0 to 1 (0.5)").range(0.0, 1.0);
}

Result<void> expect_units(const TriMesh& mesh, const std::string& in) {
  if (!mesh.frame.input_voxel.known()) {
    if (is_exa_file(in))
      return fail(ErrorKind::kUsage,
                  "{} does not say how large its voxels are, so there are no mm; process the scan again with "
                  "--voxel-size, e.g. 38um",
                  in);
    log(LogLevel::kWarning, fmt::format("{} does not state its units; taken as millimetres", in));
  }
  return {};
}

Result<ScriptSurface> read_script(const ScriptRequest& request, Progress& progress) {
  ScriptSurface out;
  DUBSAR_ASSIGN(out.mesh, load_written_part(request.in, request.part, request.unit, progress));
  DUBSAR_TRY(expect_units(out.mesh, request.in));
  WedgeSearch search;
  search.width_mm = request.width_mm;
  search.least_confidence = request.confidence;
  DUBSAR_ASSIGN(out.found, find_wedges(out.mesh, search, progress));
  return out;
}

}  // namespace dubsar::app
