// dubsar export IN.exa OUT.{ply,stl,obj,glb}

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <numbers>

#include "app/cli/default_output.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/publish/seen_colors.h"
#include "core/mesh/folds.h"
#include "core/mesh/simplify.h"
#include "core/mesh_io/mesh_io.h"
#include "core/pipeline/report.h"

namespace dubsar::app {
namespace {
struct ExportRequest {
  std::string in, out, style, unit;
  std::vector<std::string> partitions;
  MeshWriteOptions write;
  bool no_holes = false, simplify = false;
  double simplify_angle_deg = 20.0, simplify_distance_vox = 0.1;
};

Result<VerbResult> run(const ExportRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(const MeshFormat format, mesh_format_from_path(options.out));
  Shading look;
  if (!options.style.empty()) {
    DUBSAR_ASSIGN(look, shading_preset(options.style));
  }
  DUBSAR_ASSIGN(const double unit_mm, mesh_unit_mm(options.unit));
  DUBSAR_ASSIGN(TriMesh mesh, load_mesh({options.in, options.partitions, !options.no_holes, {unit_mm}}, progress));
  if (mesh.triangles.empty() && !mesh.positions.empty())
    return fail(ErrorKind::kBadData, "{}: a point cloud of {} points without triangles found, expected a surface",
                options.in, mesh.positions.size());
  if (mesh.triangles.empty())
    return fail(ErrorKind::kBadData, "{}: no triangles found, expected a surface", options.in);
  if (options.simplify) {
    const SimplifyOptions limits{options.simplify_angle_deg * std::numbers::pi / 180.0, options.simplify_distance_vox};
    DUBSAR_ASSIGN(mesh, simplify(mesh, limits, progress));
  }
  MeshWriteOptions write = options.write;
  if (!options.style.empty()) {
    DUBSAR_ASSIGN(const SurfaceFields fields, measure_fields(mesh, fields_needed(look.style), progress));
    color_as_seen(mesh, look.style, &fields);
    write.colors_derived = !mesh.shape.empty() || !mesh.ao.empty() || is_field(look.style.map);
  }
  const MeshCheck check = check_mesh(mesh.positions, mesh.triangles);
  if (format == MeshFormat::kStl) remove_folds(mesh);
  DUBSAR_TRY(write_mesh(options.out, mesh, write, progress));
  // STL knows no parts: whoever reads it joins equal points, and patches of two parts lie on each other.
  const std::int64_t coincident = format == MeshFormat::kStl ? coincident_triangles(mesh) : 0;
  const bool watertight = check.watertight() && coincident == 0;
  VerbResult result;
  result.json = {{"output", options.out},
                 {"bytes", std::filesystem::file_size(options.out)},
                 {"mesh", mesh_check_json(check)},
                 {"watertight", watertight},
                 {"coincident_triangles", coincident},
                 {"voxel_size_known", mesh.frame.input_voxel.known()},
                 {"partitions", partitions_json(mesh.partitions)}};
  result.text = fmt::format("{}: {} vertices, {} triangles, {}\n", options.out, check.vertices, check.triangles,
                            watertight             ? "watertight"
                            : check.boundary_edges ? fmt::format("{} boundary edges", check.boundary_edges)
                                                   : "each part watertight, not all of them together");
  if (coincident > 0)
    result.text += fmt::format(
        "{} triangles of patches lie on each other, once for each of two parts, and STL has no parts to tell them\n"
        "apart; for printing, write one part a file (--partition {}), or 3MF, which keeps parts\n",
        coincident, mesh.partitions.body_names().front());
  return result;
}
}  // namespace

Verb add_export_verb(Arguments program) {
  auto options = std::make_shared<ExportRequest>();
  Arguments command = program.command("export", "write surfaces as PLY, STL, OBJ, GLB or 3MF");
  command.reads("IN", options->in, "EXA file (or a mesh file, to convert it)").required();
  command.writes("OUT", options->out, FileFormat::kMesh,
                 "file to write, .ply, .stl, .obj, .glb or .3mf; unless given: beside IN, NAME.ply");
  command.value("--partition", options->partitions, "only these parts: names or ids, e.g. tablet").separated_by(',');
  command.value("--unit", options->unit, kUnitHelp);
  command.choice<MeshUnits>("--units", options->write.units, {{"mm", MeshUnits::kMm}, {"vox", MeshUnits::kVox}},
                            "mm, or vox: coordinates of the input volume; GLB is always in metres, 3MF in mm");
  command.value("--style", options->style,
                "colours of the vertices as a picture in this style shows them, as of render");
  command.flag("--compress", options->write.compress,
               "GLB for the web: quantised to 1/16 grid step, EXT_meshopt_compression");
  command.flag("--no-fill-holes", options->no_holes, "leave out the patches that close the parts");
  command.flag("--simplify", options->simplify,
               "fewer triangles where the surface is flat (adaptive vertex clustering)");
  command
      .value("--simplify-angle", options->simplify_angle_deg, "largest angle in degrees between old and new triangles")
      .range(0.0, 90.0);
  command.value("--simplify-distance", options->simplify_distance_vox, "largest distance of the surfaces in grid steps")
      .range(0.0, 100.0);
  command.footer(
      "Examples:\n"
      "  dubsar export tablet.exa\n"
      "  dubsar export tablet.exa tablet.stl --partition tablet\n"
      "  dubsar export tablet.exa envelope.glb --partition envelope --simplify\n"
      "  dubsar export tablet.exa tablet.obj --style sky-sun-ao");
  return {command, [options](const CommonOptions&, Progress& progress) { return run(*options, progress); },
          [options] {
            if (options->out.empty()) options->out = output_beside(options->in, ".ply");
          }};
}

}  // namespace dubsar::app
