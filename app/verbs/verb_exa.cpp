// dubsar exa stat|verify|recompress: what an EXA file consists of, whether it is whole, and the same surface anew.

#include <fmt/format.h>

#include <memory>

#include "app/cli/verb.h"
#include "core/exa/exa_file.h"
#include "core/exa/settle.h"
#include "core/mesh/mesh_check.h"
#include "core/pipeline/report.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

struct Options {
  std::string in, out;
  float max_error = 1.0f / 16.0f;
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

Result<VerbResult> stat(const Options& options) {
  DUBSAR_ASSIGN(const ExaInfo info, read_exa_info(options.in));
  VerbResult result;
  result.text = stats_text(info.stats);
  result.json = stats_json(info.stats);
  return result;
}

Result<VerbResult> verify(const Options& options, Progress& progress) {
  DUBSAR_TRY(check_exa_sums(options.in));
  DUBSAR_ASSIGN(const SurfaceModel model, read_exa(options.in, progress));
  DUBSAR_ASSIGN(const TriMesh mesh, make_tri_mesh(model));
  const MeshCheck check = check_mesh(mesh.positions, mesh.triangles);
  VerbResult result;
  result.json = {{"sums", "good"}, {"mesh", mesh_check_json(check)}, {"manifold", check.manifold()}};
  result.text =
      fmt::format("{}: all sums are good; {} vertices, {} triangles, {}\n", options.in, check.vertices, check.triangles,
                  check.watertight() ? "watertight"
                  : check.manifold() ? "open, a 2-manifold"
                                     : "not a 2-manifold");
  result.failed = !check.manifold();
  result.failure = ErrorKind::kBadData;
  return result;
}

Result<VerbResult> recompress(const Options& options, Progress& progress) {
  DUBSAR_ASSIGN(const ExaInfo before, read_exa_info(options.in));
  DUBSAR_ASSIGN(SurfaceModel model, read_exa(options.in, progress));
  SettleOptions settle;
  settle.max_error = options.max_error;
  settle.curvature = before.header.curvature;
  DUBSAR_ASSIGN(const SettleStats stats, settle_for_exa(model, settle, progress));
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
}  // namespace

Verb add_exa_verb(Arguments program) {
  auto options = std::make_shared<Options>();
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
  command.footer(
      "Examples:\n  dubsar exa stat tablet.exa\n  dubsar exa verify tablet.exa\n  dubsar exa recompress old.exa -o "
      "new.exa");
  return {command, [options, stat_command, verify_command](const CommonOptions&, Progress& progress) {
            if (stat_command.chosen()) return stat(*options);
            if (verify_command.chosen()) return verify(*options, progress);
            return recompress(*options, progress);
          }};
}

}  // namespace dubsar::app
