// dubsar exa stat|verify|recompress|part: what an EXA file consists of, whether it is whole, the same surface anew, and
// a coarser level or a box of it without reading the rest.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/verb.h"
#include "core/base/files/file_identity.h"
#include "core/exa/exa_file.h"
#include "core/exa/exa_plausible.h"
#include "core/exa/exa_salvage.h"
#include "core/exa/offsets/settle.h"
#include "core/mesh/mesh_check.h"
#include "core/pipeline/report.h"
#include "core/volume/formats/import_options.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

struct ExaRequest {
  std::string in, out;
  float max_error = 1.0f / 16.0f;
  std::string box;
  int level = 0;
};

json stats_json(const ExaStats& stats) {
  json blocks = json::array();
  for (const ExaBlockStats& block : stats.blocks)
    blocks.push_back({{"name", block.name},
                      {"bytes", block.bytes},
                      {"chunks", block.chunks},
                      {"bits_per_vertex", block.bits_per_vertex}});
  return {{"bytes", stats.bytes},
          {"vertices", stats.vertices},
          {"bits_per_vertex", stats.bits_per_vertex},
          {"blocks", blocks}};
}

std::string stats_text(const ExaStats& stats) {
  std::string text = fmt::format("{:<16}{:>12}{:>10}{:>16}\n", "block", "bytes", "chunks", "bits a vertex");
  double signs = 0.0;
  for (const ExaBlockStats& block : stats.blocks) {
    text += fmt::format("{:<16}{:>12}{:>10}{:>16.4f}\n", block.name, block.bytes, block.chunks, block.bits_per_vertex);
    if (block.name.starts_with("signs_")) signs += block.bits_per_vertex;
  }
  text += fmt::format("{:<16}{:>12}{:>10}{:>16.4f}\n", "all", stats.bytes, "", stats.bits_per_vertex);
  return text + fmt::format("topology {:.4f} bits a vertex, {} vertices\n", signs, stats.vertices);
}

Result<VerbResult> stat(const ExaRequest& options) {
  DUBSAR_ASSIGN(const ExaInfo info, read_exa_info(options.in));
  VerbResult result;
  result.text = stats_text(info.stats);
  result.json = stats_json(info.stats);
  result.json["version"] = info.major;
  return result;
}

Result<VerbResult> verify(const ExaRequest& options, Progress& progress) {
  DUBSAR_TRY(check_exa_sums(options.in));
  DUBSAR_ASSIGN(const ExaInfo info, read_exa_info(options.in));
  DUBSAR_ASSIGN(const SurfaceModel model, while_unchanged(options.in, [&] { return read_exa(options.in, progress); }));
  if (const Result<void> plausible = check_plausible(model, info.header, progress); !plausible)
    return fail(plausible.error().kind, "{}: {}", options.in, plausible.error().message);
  DUBSAR_ASSIGN(const TriMesh mesh, make_tri_mesh(model));
  const MeshCheck check = check_mesh(mesh.positions, mesh.triangles);
  VerbResult result;
  result.json = {{"sums", "good"}, {"mesh", mesh_check_json(check)}, {"manifold", check.manifold()}};
  result.text =
      fmt::format("{}: all sums are good; {} vertices, {} triangles, {}\n", options.in, check.vertices, check.triangles,
                  check.watertight() ? "watertight"
                  : check.manifold() ? "open, a 2-manifold"
                                     : "not a 2-manifold");
  if (!check.manifold()) result.failure = Error{ErrorKind::kBadData, options.in + " is not a 2-manifold"};
  return result;
}

Result<VerbResult> recompress(const ExaRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(const ExaInfo before, read_exa_info(options.in));
  DUBSAR_ASSIGN(SurfaceModel model, while_unchanged(options.in, [&] { return read_exa(options.in, progress); }));
  SettleOptions settle;
  settle.max_error = options.max_error;
  settle.curvature = before.header.curvature;
  settle.exact_normals = before.header.normals == ExaNormals::kExact;  // somebody asked for them
  SettleStats stats;
  if (model.patches.empty()) {  // else it was settled when its parts were made
    DUBSAR_ASSIGN(stats, settle_for_exa(model, settle, progress));
  }
  DUBSAR_ASSIGN(const ExaStats after, write_exa(options.out, model, progress));
  VerbResult result;
  result.text = fmt::format(
      "{}: {} bytes, before {}; vertices moved off the surface by {:.4f} of a grid step at most, normals by "
      "{:.2f} degrees on average, {:.1f} % of the shape classes changed\n",
      options.out, after.bytes, before.stats.bytes, stats.max_error_vox, stats.normal_error_deg,
      100.0 * stats.shape_changed_fraction);
  result.json = stats_json(after);
  result.json["bytes_before"] = before.stats.bytes;
  result.json["max_error_vox"] = stats.max_error_vox;
  result.json["p95_error_vox"] = stats.p95_error_vox;
  result.json["normal_error_deg"] = stats.normal_error_deg;
  result.json["shape_changed_fraction"] = stats.shape_changed_fraction;
  return result;
}

Result<VerbResult> salvage(const ExaRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(const SalvagedExa salvaged,
                while_unchanged(options.in, [&] { return salvage_exa(options.in, progress); }));
  DUBSAR_ASSIGN(const ExaStats stats, write_exa(options.out, salvaged.model, progress));
  VerbResult result;
  result.text = salvaged.lost.empty() ? fmt::format("{}: nothing is damaged\n", options.in)
                                      : fmt::format("{}: damaged, and left out:\n", options.in);
  for (const std::string& lost : salvaged.lost) result.text += "  " + lost + "\n";
  result.text += fmt::format("{}: {} vertices, {} bytes\n", options.out, stats.vertices, stats.bytes);
  result.json = stats_json(stats);
  result.json["left_out"] = salvaged.lost;
  return result;
}

Result<VerbResult> part(const ExaRequest& options, Progress& progress) {
  if (options.box.empty() == (options.level == 0))
    return fail(ErrorKind::kUsage, "exa part: either --level or --box is needed");
  DUBSAR_ASSIGN(const ExaInfo whole, read_exa_info(options.in));
  const auto read = [&]() -> Result<SurfaceModel> {
    if (options.level > 0) return read_exa_level(options.in, options.level, progress);
    DUBSAR_ASSIGN(const CropRange range, parse_crop(options.box));
    const Dims& dims = whole.header.dims;
    const std::array<std::int64_t, 3> size{dims.x, dims.y, dims.z};
    GridBox box;
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = range.begin[a];
      box.high[a] = range.end[a] > 0 ? range.end[a] - 1 : size[a] - 1;
    }
    return read_exa_box(options.in, box, progress);
  };
  DUBSAR_ASSIGN(const SurfaceModel model, read());
  DUBSAR_ASSIGN(const ExaStats stats, write_exa(options.out, model, progress));
  VerbResult result;
  result.text =
      fmt::format("{}: {} of {} vertices, {} bytes\n", options.out, stats.vertices, whole.stats.vertices, stats.bytes);
  result.json = stats_json(stats);
  result.json["vertices_of_the_whole"] = whole.stats.vertices;
  return result;
}
}  // namespace

Verb add_exa_verb(Arguments program) {
  auto options = std::make_shared<ExaRequest>();
  Arguments command = program.command("exa", "look into EXA files, check them, write them anew");
  command.needs_command();
  Arguments stat_command = command.subcommand("stat", "bits by block and level");
  stat_command.reads("FILE", options->in, "EXA file").required();
  Arguments verify_command =
      command.subcommand("verify", "check sums, decode, and check that the mesh is a 2-manifold");
  verify_command.reads("FILE", options->in, "EXA file").required();
  Arguments recompress_command = command.subcommand("recompress", "decode and encode");
  recompress_command.reads("IN", options->in, "EXA file").required();
  recompress_command.writes("-o,--output", options->out, FileFormat::kExa, "EXA file to write").required();
  recompress_command
      .value("--max-error", options->max_error, "largest distance of a vertex from the surface before, in grid steps")
      .positive();
  Arguments salvage_command = command.subcommand(
      "salvage", "what is whole of a damaged file: what is left out is named, lost bricks are marked as inferred");
  salvage_command.reads("IN", options->in, "EXA file").required();
  salvage_command.writes("-o,--output", options->out, FileFormat::kExa, "EXA file to write").required();
  Arguments part_command = command.subcommand("part", "a coarser level or a box, without reading the rest");
  part_command.reads("IN", options->in, "EXA file").required();
  part_command.writes("-o,--output", options->out, FileFormat::kExa, "EXA file to write").required();
  part_command.value("--level", options->level, "every 2nd, 4th or 8th grid point: 1, 2, 3").range(1, 3);
  part_command.value("--box", options->box,
                     "x0:x1,y0:y1,z0:z1 in grid points; the bricks of 128 that touch it, open where they end");
  command.footer(
      "Examples:\n"
      "  dubsar exa stat tablet.exa\n"
      "  dubsar exa verify tablet.exa\n"
      "  dubsar exa recompress old.exa -o new.exa\n"
      "  dubsar exa salvage damaged.exa -o rest.exa\n"
      "  dubsar exa part tablet.exa --level 2 -o preview.exa");
  return {command, [options, stat_command, verify_command, salvage_command, part_command](const CommonOptions&,
                                                                                          Progress& progress) {
            if (stat_command.chosen()) return stat(*options);
            if (verify_command.chosen()) return verify(*options, progress);
            if (salvage_command.chosen()) return salvage(*options, progress);
            if (part_command.chosen()) return part(*options, progress);
            return recompress(*options, progress);
          }};
}

}  // namespace dubsar::app
