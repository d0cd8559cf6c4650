#include "app/cli/mesh_input.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "core/base/files/file_identity.h"
#include "core/base/files/file_suffix.h"
#include "core/base/numbers/units.h"
#include "core/base/text/near_word.h"
#include "core/exa/exa_file.h"
#include "core/mesh/pores_by_body.h"
#include "core/mesh/vertex_attributes.h"
#include "core/mesh_io/mesh_io.h"
#include "core/parts/surface_model.h"

namespace dubsar::app {
namespace {

std::optional<int> as_id(const std::string& text) {
  int id = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(id) : std::nullopt;
}

tl::unexpected<Error> no_such_partition(const std::string& wanted, const PartitionTable& partitions) {
  if (partitions.empty())
    return fail(ErrorKind::kUsage, "there is no part \"{}\": the surface is one piece, expected no name of a part",
                wanted);
  std::vector<std::string> names = partitions.body_names();
  for (const Partition& p : partitions)
    if (std::find(names.begin(), names.end(), p.name) == names.end()) names.push_back(p.name);
  return fail(ErrorKind::kUsage, "there is no part \"{}\", expected one of: {}{}", wanted, fmt::join(names, ", "),
              did_you_mean(wanted, names));
}

bool names_a_part(const PartitionTable& partitions, const std::string& wanted) {
  return std::any_of(partitions.begin(), partitions.end(),
                     [&](const Partition& p) { return p.name == wanted || p.body == wanted || as_id(wanted) == p.id; });
}

/// What a name or id stands for in an EXA file: a whole part or a single partition.
Result<MeshOptions> mesh_options(const SurfaceModel& model, const std::string& wanted, bool fill_holes) {
  MeshOptions options;
  options.fill_holes = fill_holes;
  for (const Partition& p : model.partitions) {
    if (p.name == wanted || as_id(wanted) == p.id) {
      options.partition = p.id;
      return options;
    }
    if (p.body == wanted) options.body = wanted;
  }
  if (options.body) return options;
  return no_such_partition(wanted, model.partitions);
}

void append(TriMesh& to, const TriMesh& from) {
  const auto base = static_cast<std::uint32_t>(to.positions.size());
  if (!to.triangle_inferred.empty() || !from.triangle_inferred.empty()) {  // a part without marks is measured
    to.triangle_inferred.resize(to.triangles.size(), 0);
    to.triangle_inferred.insert(to.triangle_inferred.end(), from.triangle_inferred.begin(),
                                from.triangle_inferred.end());
    to.triangle_inferred.resize(to.triangles.size() + from.triangles.size(), 0);
  }
  for (Triangle t : from.triangles) to.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  const auto& labels = from.triangle_partition;
  to.triangle_partition.insert(to.triangle_partition.end(), labels.begin(), labels.end());
  append_vertices(to, from);
  to.partitions.merge(from.partitions);
}

Result<TriMesh> load_exa(const MeshRequest& request, Progress& progress) {
  DUBSAR_TRY(check_parts(request.path, request.partitions));
  DUBSAR_ASSIGN(const SurfaceModel model,
                while_unchanged(request.path, [&] { return read_exa(request.path, progress); }));
  MeshOptions all;
  all.fill_holes = request.fill_holes;
  all.progress = &progress;
  if (request.partitions.empty()) return make_tri_mesh(model, all);
  std::optional<TriMesh> joined;
  for (const std::string& wanted : request.partitions) {
    DUBSAR_ASSIGN(MeshOptions options, mesh_options(model, wanted, request.fill_holes));
    options.progress = &progress;
    DUBSAR_ASSIGN(TriMesh part, make_tri_mesh(model, options));
    if (joined)
      append(*joined, part);
    else
      joined = std::move(part);
  }
  return std::move(*joined);
}

Result<TriMesh> load_foreign(const MeshRequest& request, Progress& progress,
                             const std::function<void(TriMesh)>& tell_coarse) {
  // A coarse surface is in the file's own unit.
  const bool coarse = request.partitions.empty() && request.foreign.unit_mm == 0.0;
  DUBSAR_ASSIGN(TriMesh mesh, while_unchanged(request.path, [&] {
                  return read_mesh(request.path, progress, request.foreign,
                                   coarse ? tell_coarse : std::function<void(TriMesh)>());
                }));
  if (request.partitions.empty()) return mesh;
  std::optional<TriMesh> joined;
  for (const std::string& wanted : request.partitions) {
    int id = as_id(wanted).value_or(-1);
    for (const Partition& p : mesh.partitions)
      if (p.name == wanted) id = p.id;
    const auto& labels = mesh.triangle_partition;
    if (std::find(labels.begin(), labels.end(), id) == labels.end()) return no_such_partition(wanted, mesh.partitions);
    TriMesh part = select_partitions(mesh, static_cast<std::uint8_t>(1u << id));
    if (joined)
      append(*joined, part);
    else
      joined = std::move(part);
  }
  return std::move(*joined);
}

}  // namespace

bool is_exa_file(const std::filesystem::path& path) {
  const auto info = read_exa_info(path);
  return info.has_value() || lower_suffix(path) == ".exa";
}

Result<double> mesh_unit_mm(const std::string& unit) {
  if (unit.empty()) return 0.0;
  const std::optional<double> mm = mm_per_unit(unit);
  if (!mm) return fail(ErrorKind::kUsage, "--unit {} found, expected m, cm, mm, um, nm or inch", unit);
  return *mm;
}

Result<void> check_parts(const std::filesystem::path& path, std::span<const std::string> names) {
  if (names.empty()) return {};
  const auto info = read_exa_info(path);  // what is wrong with the file, reading it says
  if (!info) return {};
  for (const std::string& wanted : names)
    if (!names_a_part(info->partitions, wanted)) return no_such_partition(wanted, info->partitions);
  return {};
}

Result<TriMesh> load_mesh(const MeshRequest& request, Progress& progress) { return load_mesh(request, progress, {}); }

Result<TriMesh> load_mesh(const MeshRequest& request, Progress& progress,
                          const std::function<void(TriMesh)>& tell_coarse) {
  const bool exa = is_exa_file(request.path);
  if (exa && request.foreign.unit_mm > 0)
    return fail(ErrorKind::kUsage, "--unit found with {}, which says its own unit, expected it with a mesh file only",
                request.path.string());
  DUBSAR_ASSIGN(TriMesh mesh, exa ? load_exa(request, progress) : load_foreign(request, progress, tell_coarse));
  if (request.divide_pores) divide_pores(mesh);
  return mesh;
}

Result<TriMesh> load_written_part(const std::string& path, const std::string& part, const std::string& unit,
                                  Progress& progress, bool photo_detail) {
  DUBSAR_ASSIGN(const double unit_mm, mesh_unit_mm(unit));
  const MeshReadOptions foreign{unit_mm, photo_detail};
  if (part != "auto" && part != "all") return load_mesh({path, {part}, true, foreign}, progress);
  if (part == "auto")
    if (Result<TriMesh> tablet = load_mesh({path, {"tablet"}, true, foreign}, progress);
        tablet || tablet.error().kind != ErrorKind::kUsage)
      return tablet;
  return load_mesh({path, {}, true, foreign}, progress);
}

}  // namespace dubsar::app
