// dubsar info FILE: what is in a volume, a surface or a mesh file, without processing it.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "app/cli/input_options.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/publish/surface_facts.h"
#include "core/base/files/file_suffix.h"
#include "core/base/numbers/units.h"
#include "core/base/system/budget.h"
#include "core/base/text/plain_text.h"
#include "core/exa/exa_file.h"
#include "core/mesh_io/mesh_io.h"
#include "core/pipeline/forecast.h"
#include "core/pipeline/report.h"
#include "core/volume/formats/import.h"

namespace dubsar::app {
namespace {
using nlohmann::json;
namespace fs = std::filesystem;

struct InfoRequest {
  std::string in, unit;
  InputOptionTexts input;
  Detail detail = Detail::kAuto;
  std::string memory;
};

std::string length_text(const VoxelSize& voxel) {
  if (!voxel.known()) return "unknown";
  return fmt::format("{:g} x {:g} x {:g} mm ({})", voxel.mm.x, voxel.mm.y, voxel.mm.z, plain_text(voxel.provenance));
}

/// What `process` will take, in one line; why not, where that cannot be said.
std::string forecast_text(const Result<Forecast>& forecast) {
  if (!forecast) return fmt::format("  process      cannot be foretold: {}\n", forecast.error().message);
  const Forecast& f = *forecast;
  const double minutes = f.cost.wall_s / 60.0;
  std::string text = fmt::format(
      "  process      about {}, {:.1f} GiB of memory, {:.1f} MiB for the surface{}\n",
      minutes < 2.0 ? fmt::format("{:.0f} s", f.cost.wall_s) : fmt::format("{:.0f} minutes", minutes),
      gib_of(f.memory_bytes()), mib_of(product_bytes(f.run)),
      f.cost.scratch_bytes == 0.0 ? std::string()
                                  : fmt::format(" and {:.1f} GiB of disk meanwhile", gib_of(f.cost.scratch_bytes)));
  return text + fmt::format("               {} resolution, about {:.1f} million vertices, nobody else at work\n",
                            f.detail.resample() ? "half the scan's" : "the scan's", f.run.vertices * 1e-6);
}

json forecast_json(const Result<Forecast>& forecast) {
  if (!forecast) return {{"refusal", forecast.error().message}};
  const Forecast& f = *forecast;
  const Dims grid = grid_of(f.run.scan, f.run.half);
  return {{"detail", name_in(kDetails, f.detail.detail)},
          {"grid", {grid.x, grid.y, grid.z}},
          {"vertices", std::llround(f.run.vertices)},
          {"core_s", f.cost.core_s},
          {"wall_s", f.cost.wall_s},
          {"memory_bytes", std::llround(f.memory_bytes())},
          {"most_memory", f.cost.when},
          {"scratch_bytes", std::llround(f.cost.scratch_bytes)},
          {"product_bytes", std::llround(product_bytes(f.run))}};
}

Result<VerbResult> volume_info(const InfoRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(const ImportOptions import, parse_input_options(options.in, options.input));
  if (!options.memory.empty()) {
    DUBSAR_ASSIGN(const std::uint64_t bytes, parse_bytes(options.memory));
    set_memory_limit(bytes);
  }
  DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> volume, open_volume(import));
  const VolumeInfo& info = volume->info();
  const Dims dims = volume->dims();
  VerbResult result;
  result.json = volume_json(info);
  result.json["kind"] = "volume";
  result.json["warnings"] = info.warnings;
  DUBSAR_ASSIGN(const Unmeasured unmeasured, volume->unmeasured());
  result.json["unmeasured"] = unmeasured_json(unmeasured);
  Result<Forecast> expected =
      forecast(*volume, {}, options.detail, import.budget, unmeasured.left_out(), /*look_for_rays=*/true, progress);
  if (!expected && expected.error().kind == ErrorKind::kCancelled) return tl::unexpected<Error>(expected.error());
  result.json["process"] = forecast_json(expected);
  if (expected)
    result.json["artefacts"] = {
        {"bent_rays", expected->bent_rays ? bent_rays_json(*expected->bent_rays) : json(nullptr)},
        {"rings", expected->rings ? json(describe(*expected->rings)) : json(nullptr)},
        {"holder", expected->holder ? holder_json(*expected->holder, volume->frame().input_voxel) : json(nullptr)},
        {"seen_bend", {{"bend", expected->seen_bend.bend}, {"share", expected->seen_bend.share}}}};
  std::string& text = result.text;
  text = fmt::format("volume ({}{}{})\n", info.format, info.dataset.empty() ? "" : ", ", info.dataset);
  if (!info.found_by.empty()) text += fmt::format("  found by     {}\n", info.found_by);
  text += fmt::format("  size         {} x {} x {} voxels (x, y, z)", dims.x, dims.y, dims.z);
  text += dims == info.file_dims
              ? "\n"
              : fmt::format(" of {} x {} x {}\n", info.file_dims.x, info.file_dims.y, info.file_dims.z);
  text += fmt::format("  axes         {}\n", describe(info.axes));
  text +=
      fmt::format("  type         {}, {} endian, {}\n", info.stored.dtype, info.stored.byte_order, info.stored.layout);
  for (const std::string& filter : info.stored.filters) text += fmt::format("  filter       {}\n", filter);
  text += fmt::format("  voxel size   {}\n", length_text(info.voxel));
  text += fmt::format("  in the file  {:.1f} MiB of {:.1f} MiB\n", mib_of(info.stored.storage_bytes),
                      mib_of(info.stored.logical_bytes));
  if (unmeasured.left_out()) text += fmt::format("  outside      about {}\n", describe(unmeasured));
  if (expected) {
    text += fmt::format("  artefacts    {}\n",
                        rays_text({expected->bent_rays, {}, {}, expected->seen_bend}, volume->frame()));
    if (expected->bent_rays) text += fmt::format("               {}\n", kAdviceForBentRays);
    if (expected->holder)
      text += fmt::format("               {}\n", describe(*expected->holder, volume->frame().input_voxel));
    if (expected->rings) text += fmt::format("               {}\n", describe(*expected->rings));
  }
  text += forecast_text(expected);
  for (const VolumeCandidate& other : info.candidates)
    text += fmt::format("  also there   {} ({})\n", other.dataset, other.dtype);
  return result;
}

void add_partitions_text(std::string& text, const PartitionTable& partitions) {
  for (const Partition& p : partitions)
    text += fmt::format("  part {}       {}: {:.1f} mm2, {:.1f} mm3, {}\n", p.id, p.name, p.area_mm2, p.volume_mm3,
                        p.watertight ? "watertight" : "open");
}

Result<VerbResult> exa_info(const InfoRequest& options, bool verbose, Progress& progress) {
  DUBSAR_ASSIGN(const ExaInfo info, read_exa_info(options.in));
  DUBSAR_TRY(check_exa_sums(options.in));
  DUBSAR_ASSIGN(const TriMesh mesh, load_mesh({options.in, {}, true}, progress));
  SurfaceFacts facts;
  if (!mesh.triangles.empty()) {
    DUBSAR_ASSIGN(facts, surface_facts(mesh));
  }
  VerbResult result;
  json blocks = json::object();
  for (const ExaBlockStats& block : info.stats.blocks)
    blocks[block.name] = {{"bytes", block.bytes}, {"bits_per_vertex", block.bits_per_vertex}};
  result.json = {
      {"kind", "exa"},
      {"version", {info.major, info.minor}},
      {"grid", {info.header.dims.x, info.header.dims.y, info.header.dims.z}},
      {"vertices", info.header.vertices},
      {"xquads", info.header.quads},
      {"threshold", info.header.isovalue},
      {"offset_bits", info.header.offset_bits},
      {"voxel_size_mm",
       {info.header.frame.input_voxel.mm.x, info.header.frame.input_voxel.mm.y, info.header.frame.input_voxel.mm.z}},
      {"voxel_size_known", info.header.frame.input_voxel.known()},
      {"bytes", info.stats.bytes},
      {"bits_per_vertex", info.stats.bits_per_vertex},
      {"blocks", blocks},
      {"partitions", partitions_json(info.partitions)}};
  result.json["provenance"] = info.provenance.empty() ? json(nullptr) : json::parse(info.provenance, nullptr, false);
  result.json["sums_good"] = true;
  result.json["facts"] = facts_json(facts);
  std::string& text = result.text;
  text = fmt::format("surface (EXA {}.{}), whole: all sums are good\n", info.major, info.minor);
  text += fmt::format("  {}\n", what_it_is(facts));
  text += fmt::format("  box          {} (along the scan)\n", size_text(facts.box, facts.millimetres));
  text += fmt::format("  voxel size   {}\n", length_text(info.header.frame.input_voxel));
  text += fmt::format("  grid         {} x {} x {}, threshold {:g}\n", info.header.dims.x, info.header.dims.y,
                      info.header.dims.z, info.header.isovalue);
  text += fmt::format("  mesh         {} vertices, {} x-quads\n", info.header.vertices, info.header.quads);
  text +=
      fmt::format("  file         {} bytes, {:.2f} bits per vertex\n", info.stats.bytes, info.stats.bits_per_vertex);
  for (const ExaBlockStats& block : info.stats.blocks)
    if (verbose)
      text += fmt::format("  block        {:<16}{:>12} bytes {:>8.2f} bits per vertex\n", block.name, block.bytes,
                          block.bits_per_vertex);
  text += "\n" + facts_text(facts);
  if (verbose) text += "\n", add_partitions_text(text, info.partitions);
  return result;
}

constexpr double kFarOff = 8.0;  // extents from the origin on where a surface lies is said

Result<VerbResult> describe_mesh(const InfoRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(const double unit_mm, mesh_unit_mm(options.unit));
  DUBSAR_ASSIGN(const MeshInfo info, mesh_info(options.in, progress, {unit_mm}));
  const MeshCheck& check = info.check;
  VerbResult result;
  result.json = {{"kind", info.triangles == 0 && info.vertices > 0 ? "points" : "mesh"},
                 {"format", mesh_format_name(info.format)},
                 {"bytes", info.bytes},
                 {"mesh", mesh_check_json(check)},
                 {"watertight", check.watertight()},
                 {"min_mm", {info.min_mm.x, info.min_mm.y, info.min_mm.z}},
                 {"max_mm", {info.max_mm.x, info.max_mm.y, info.max_mm.z}},
                 {"unit_known", info.unit.known()},
                 {"attributes", info.attributes},
                 {"partitions", partitions_json(info.partitions)}};
  if (info.way) {
    result.json["up_probability"] = info.way->up_probability;
    result.json["obverse_probability"] = info.way->obverse_probability;
    result.json["mirrored_probability"] = info.way->mirrored_probability;
  }
  const glm::dvec3 size = info.max_mm - info.min_mm;
  const double longest = std::max({size.x, size.y, size.z});
  const int digits = longest > 0 && longest < 1.0 ? 6 : 3;
  std::string& text = result.text;
  const bool cloud = info.triangles == 0 && info.vertices > 0;
  text = fmt::format("{} ({})\n", cloud ? "point cloud" : "mesh", mesh_format_name(info.format));
  text += fmt::format("  mesh         {} vertices, {} triangles, {} components\n", info.vertices, info.triangles,
                      check.components);
  text += fmt::format("  box          {:.{}f} x {:.{}f} x {:.{}f} {}\n", size.x, digits, size.y, digits, size.z, digits,
                      info.unit.known() ? fmt::format("mm ({})", info.unit.provenance) : "(unit unknown, taken as mm)");
  const glm::dvec3 middle = 0.5 * (info.min_mm + info.max_mm);
  if (std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}) > kFarOff * longest)
    text += fmt::format("  lies at      {:.3f}, {:.3f}, {:.3f}\n", middle.x, middle.y, middle.z);
  if (info.triangles == 0)
    text += fmt::format("  surface      none: {}\n", cloud ? "points without triangles" : "the file has no triangles");
  else
    text += fmt::format("  surface      {}\n",
                        check.watertight()
                            ? "watertight 2-manifold"
                            : fmt::format("{} boundary edges, {} non-manifold edges, {} non-manifold vertices",
                                          check.boundary_edges, check.nonmanifold_edges, check.nonmanifold_vertices));
  if (info.way)
    text += fmt::format("  way up       {}\n",
                        info.way->sure() ? fmt::format("known (probability {:.2f}), and the obverse ({:.2f})",
                                                       info.way->up_probability, info.way->obverse_probability)
                                         : info.way->doubt());
  for (const std::string& attribute : info.attributes) text += fmt::format("  attribute    {}\n", attribute);
  add_partitions_text(text, info.partitions);
  return result;
}

Result<VerbResult> run(const InfoRequest& options, bool verbose, Progress& progress) {
  const bool raw = !options.input.dims.empty() || !options.input.type.empty();
  if (!raw && is_exa_file(options.in)) return exa_info(options, verbose, progress);
  // glTF as text is refused with its own sentence.
  if (!raw && (mesh_format_from_path(options.in) || lower_suffix(options.in) == ".gltf"))
    return describe_mesh(options, progress);
  return volume_info(options, progress);
}
}  // namespace

Verb add_info_verb(Arguments program) {
  auto options = std::make_shared<InfoRequest>();
  Arguments command = program.command("info", "say what is in a volume, surface or mesh file");
  command.reads("FILE", options->in, "volume (HDF5, NRRD, TIFF, raw), EXA, PLY, STL, OBJ or GLB").required();
  command.value("--unit", options->unit, kUnitHelp);
  command.choice<Detail>("--detail", options->detail, choices_of(kDetails),
                         "for what process will take: grid of the surface, as there (auto, scan, half)");
  command.value("--memory", options->memory, "for the same: most memory that it may take, such as 6G").called("SIZE");
  add_input_options(command, options->input);
  command.footer(
      "Examples:\n  dubsar info scan.h5\n  dubsar info scan.h5:/entry/data/data\n  dubsar info tablet.exa --json -");
  return {command, [options](const CommonOptions& common, Progress& progress) {
            return run(*options, common.console.verbose, progress);
          }};
}

}  // namespace dubsar::app
