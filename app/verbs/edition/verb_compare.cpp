// dubsar compare A B: one surface laid on another, and how far they are apart, in figures and colours.

#include <fmt/format.h>

#include <memory>

#include "app/cli/default_output.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "core/base/system/log.h"
#include "core/compare/surface_difference.h"
#include "core/mesh_io/mesh_io.h"

namespace dubsar::app {
namespace {

struct CompareRequest {
  std::string a, b, out, part = "auto", unit;
  double range_mm = 0.25, reach_mm = 2.0;
};

Result<TriMesh> compared_surface(const CompareRequest& request, const std::string& path, Progress& progress) {
  DUBSAR_ASSIGN(TriMesh mesh, load_written_part(path, request.part, request.unit, progress));
  if (!mesh.frame.input_voxel.known()) {
    if (is_exa_file(path))
      return fail(ErrorKind::kUsage,
                  "{} does not say how large its voxels are, so there are no mm; process the scan again with "
                  "--voxel-size, e.g. 38um",
                  path);
    log(LogLevel::kWarning, fmt::format("{} does not state its units; taken as millimetres", path));
  }
  return mesh;
}

Result<VerbResult> run_compare(const CompareRequest& request, Progress& progress) {
  DUBSAR_TRY(mesh_format_from_path(request.out));
  DUBSAR_ASSIGN(const TriMesh a, compared_surface(request, request.a, progress));
  DUBSAR_ASSIGN(TriMesh b, compared_surface(request, request.b, progress));
  DUBSAR_ASSIGN(const SurfaceDifference difference, difference_of(a, b, request.reach_mm, progress));
  b.colors.clear();
  for (const double mm : difference.vertex_mm) b.colors.push_back(difference_color(mm, request.range_mm));
  DUBSAR_TRY(write_mesh(request.out, b, {}, progress));
  const SurfaceAlignment& laid = difference.alignment;
  VerbResult result;
  result.json = {{"output", request.out},
                 {"compared_mm2", difference.compared_mm2},
                 {"left_out_mm2", difference.left_out_mm2},
                 {"mean_mm", difference.mean_mm},
                 {"rms_mm", difference.rms_mm},
                 {"median_mm", difference.median_mm},
                 {"most_mm", difference.most_mm},
                 {"within_0.05_mm", difference.within_05},
                 {"within_0.1_mm", difference.within_10},
                 {"alignment_rms_mm", laid.rms_mm},
                 {"attitude", laid.attitude},
                 {"turned_deg", angle_deg(laid.a_from_b)},
                 {"range_mm", request.range_mm}};
  for (int r = 0; r < 3; ++r)
    result.json["a_from_b"].push_back(
        {laid.a_from_b.turn[0][r], laid.a_from_b.turn[1][r], laid.a_from_b.turn[2][r], laid.a_from_b.shift[r]});
  const double all = difference.compared_mm2 + difference.left_out_mm2;
  result.text = fmt::format(
      "{}: laid on {} within {:.4f} mm\n"
      "apart: {:.4f} mm RMS, {:.4f} median, {:.3f} at most on 99 % of it; mean {:+.4f}\n"
      "within .05 mm: {:.1f} %, within .1 mm: {:.1f} % of {:.0f} mm2 that both scans show ({:.1f} % of the surface)\n"
      "{}: orange where there is more clay, blue where there is less, full at {:g} mm; dubsar render {} --style "
      "photograph\n",
      request.b, request.a, laid.rms_mm, difference.rms_mm, difference.median_mm, difference.most_mm,
      difference.mean_mm, 100.0 * difference.within_05, 100.0 * difference.within_10, difference.compared_mm2,
      all > 0 ? 100.0 * difference.compared_mm2 / all : 0.0, request.out, request.range_mm, request.out);
  return result;
}

}  // namespace

Verb add_compare_verb(Arguments program) {
  auto request = std::make_shared<CompareRequest>();
  Arguments command =
      program.command("compare", "how far two surfaces of one tablet are apart, in figures and colours");
  command.reads("A", request->a, "EXA, PLY, OBJ, STL or GLB file: the first one").required();
  command.reads("B", request->b, "the other one, as before and after, or of another scan").required();
  command.writes("-o,--output", request->out, FileFormat::kMesh,
                 "PLY or GLB file to write: B in colours. Unless given: beside B, NAME_difference.ply");
  command.value("--part", request->part, "which part: tablet where there is one (auto), all, envelope, ...");
  command.value("--unit", request->unit, kUnitHelp);
  command.value("--range", request->range_mm, "difference that has the full colour, mm (0.25)").positive();
  command.value("--reach", request->reach_mm, "what is farther away than this is left out, mm (2)").positive();
  command.footer(
      "Examples:\n"
      "  dubsar compare before.exa after.exa\n"
      "  dubsar compare scan1.exa scan2.exa -o difference.ply --range 0.1\n"
      "  dubsar render difference.ply --style photograph");
  return {command, [request](const CommonOptions&, Progress& progress) { return run_compare(*request, progress); },
          [request] {
            if (request->out.empty() && !request->b.empty())
              request->out = output_beside(request->b, "_difference.ply");
          }};
}

}  // namespace dubsar::app
