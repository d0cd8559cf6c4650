#include "core/mesh_io/mesh_io.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/files/file_suffix.h"
#include "core/base/files/input_file.h"
#include "core/mesh/vertex_attributes.h"
#include "core/mesh_io/coarse_surface.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/no_mesh.h"
#include "core/mesh_io/text_encoding.h"

namespace dubsar {
namespace {
struct Format {
  MeshFormat format;
  std::string_view name, suffix;
  Result<TriMesh> (*parse)(std::string_view, Progress&, const MeshReadOptions&);
  Result<void> (*write)(const std::filesystem::path&, const TriMesh&, const MeshWriteOptions&, Progress&);
};

template <Result<TriMesh> (*kParse)(std::string_view, Progress&)>
Result<TriMesh> parse_plain(std::string_view bytes, Progress& progress, const MeshReadOptions&) {
  return kParse(bytes, progress);
}

constexpr std::array<Format, 5> kFormats{{{MeshFormat::kPly, "ply", ".ply", parse_plain<parse_ply>, write_ply},
                                          {MeshFormat::kStl, "stl", ".stl", parse_plain<parse_stl>, write_stl},
                                          {MeshFormat::kObj, "obj", ".obj", parse_plain<parse_obj>, write_obj},
                                          {MeshFormat::kGlb, "glb", ".glb", parse_glb, write_glb},
                                          {MeshFormat::k3mf, "3mf", ".3mf", parse_plain<parse_3mf>, write_3mf}}};

const Format& row(MeshFormat format) { return kFormats[static_cast<std::size_t>(format)]; }

/// By content where it is unmistakable, else by suffix: STL and OBJ have no magic number.
Result<MeshFormat> recognise(const std::filesystem::path& path, std::string_view bytes) {
  if (bytes.empty()) return fail(ErrorKind::kBadData, "{}: the file is empty", path.string());
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::kPly;
  if (bytes.starts_with("glTF")) return MeshFormat::kGlb;
  const auto by_suffix = mesh_format_from_path(path);
  if (const auto other = what_is_no_mesh(bytes); other && !(by_suffix && *by_suffix == MeshFormat::k3mf))
    return fail(ErrorKind::kBadData, "{}: {}", path.string(), *other);
  if (by_suffix) return *by_suffix;
  if (starts_like_stl(bytes)) return MeshFormat::kStl;
  return fail(ErrorKind::kBadData, "{}: neither content nor suffix is that of a PLY, STL, OBJ or GLB file",
              path.string());
}

struct Loaded {
  MeshFormat format;
  std::int64_t bytes;
  TriMesh mesh;
};

/// A person says what one unit is.
Result<void> set_unit(TriMesh& mesh, double unit_mm) {
  VoxelSize& voxel = mesh.frame.input_voxel;
  const bool metres = voxel.provenance == kGltfMetres;
  if (voxel.known() && !metres)
    return fail(ErrorKind::kUsage, "a unit of {} mm was given, but the file says its own ({}), expected none", unit_mm,
                voxel.provenance);
  voxel.mm *= metres ? unit_mm / kMmPerGltfUnit : unit_mm;
  voxel.provenance = "unit that was given";
  return {};
}

Result<Loaded> load(const std::filesystem::path& path, Progress& progress, const MeshReadOptions& options,
                    const std::function<void(TriMesh)>& tell_coarse = {}) {
  DUBSAR_ASSIGN(std::string bytes, read_file_bytes(path));
  bytes = utf8_bytes(std::move(bytes));
  DUBSAR_ASSIGN(const MeshFormat format, recognise(path, bytes));
  try {
    if (tell_coarse)
      if (auto coarse = coarse_surface(format, bytes)) tell_coarse(*std::move(coarse));
    auto mesh = row(format).parse(bytes, progress, options);
    if (mesh && options.unit_mm > 0)
      if (const auto set = set_unit(*mesh, options.unit_mm); !set) return tl::unexpected<Error>(set.error());
    if (!mesh) {
      Error error = std::move(mesh).error();
      if (error.kind == ErrorKind::kBadData) error.message = path.string() + ": " + error.message;
      return tl::unexpected<Error>(std::move(error));
    }
    return Loaded{format, static_cast<std::int64_t>(bytes.size()), std::move(*mesh)};
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::kTryAgain, "{}: out of memory while reading a mesh of {} bytes", path.string(),
                bytes.size());
  }
}
}  // namespace

std::string_view mesh_format_name(MeshFormat format) noexcept { return row(format).name; }

Result<MeshFormat> mesh_format_from_path(const std::filesystem::path& path) {
  const std::string suffix = lower_suffix(path);
  for (const Format& format : kFormats)
    if (format.suffix == suffix) return format.format;
  return fail(ErrorKind::kUsage, "{}: suffix \"{}\" found, expected .ply, .stl, .obj, .glb or .3mf", path.string(),
              suffix);
}

Result<void> write_mesh(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                        Progress& progress) {
  DUBSAR_ASSIGN(const MeshFormat format, mesh_format_from_path(path));
  if (options.compress && format != MeshFormat::kGlb)
    return fail(ErrorKind::kUsage, "{}: only GLB can be compressed; give a name that ends in .glb", path.string());
  return row(format).write(path, mesh, options, progress);
}

Result<TriMesh> read_mesh(const std::filesystem::path& path, Progress& progress) {
  DUBSAR_ASSIGN(Loaded loaded, load(path, progress, {}));
  return std::move(loaded.mesh);
}

Result<TriMesh> read_mesh(const std::filesystem::path& path, Progress& progress, const MeshReadOptions& options,
                          const std::function<void(TriMesh)>& tell_coarse) {
  DUBSAR_ASSIGN(Loaded loaded, load(path, progress, options, tell_coarse));
  return std::move(loaded.mesh);
}

Result<MeshInfo> mesh_info(const std::filesystem::path& path, Progress& progress, const MeshReadOptions& options) {
  DUBSAR_ASSIGN(const Loaded loaded, load(path, progress, options));
  const TriMesh& mesh = loaded.mesh;
  MeshInfo info;
  info.format = loaded.format;
  info.bytes = loaded.bytes;
  info.vertices = static_cast<std::int64_t>(mesh.positions.size());
  info.triangles = static_cast<std::int64_t>(mesh.triangles.size());
  info.check = check_mesh(mesh.positions, mesh.triangles);
  info.unit = mesh.frame.input_voxel;
  info.partitions = mesh.partitions;
  info.provenance = mesh.provenance;
  if (!mesh.positions.empty()) {
    info.min_mm = glm::dvec3(std::numeric_limits<double>::max());
    info.max_mm = glm::dvec3(std::numeric_limits<double>::lowest());
  }
  const auto add = [&](std::uint32_t v) {
    const glm::dvec3 p = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
    info.min_mm = glm::min(info.min_mm, p);
    info.max_mm = glm::max(info.max_mm, p);
  };
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) add(v);
  if (mesh.triangles.empty())
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) add(v);
  for_each_attribute([&](const auto& attribute) {
    if (!(mesh.*attribute.values).empty()) info.attributes.emplace_back(attribute.name);
  });
  if (!mesh.triangle_partition.empty()) info.attributes.emplace_back("partition");
  if (const auto way = find_tablet_frame(mesh)) info.way = *way;
  return info;
}

TriMesh select_partitions(const TriMesh& mesh, std::uint8_t partitions) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  const auto chosen = [&](PartitionId id) { return id < PartitionTable::kMost && (partitions >> id & 1) != 0; };
  TriMesh part;
  part.frame = mesh.frame;
  part.provenance = mesh.provenance;
  for (const Partition& row : mesh.partitions)
    if (chosen(row.id)) part.partitions.merge(PartitionTable{row});
  std::vector<std::uint32_t> moved(mesh.positions.size(), kUnused), kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (chosen(mesh.partition_of(t)))
      for (const std::uint32_t v : mesh.triangles[t]) moved[v] = 0;
  for (std::uint32_t v = 0; v < moved.size(); ++v)
    if (moved[v] != kUnused) {
      moved[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
    }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!chosen(mesh.partition_of(i))) continue;
    const Triangle& t = mesh.triangles[i];
    part.triangles.push_back({moved[t[0]], moved[t[1]], moved[t[2]]});
    if (!mesh.triangle_partition.empty()) part.triangle_partition.push_back(mesh.triangle_partition[i]);
    if (!mesh.triangle_inferred.empty()) part.triangle_inferred.push_back(mesh.triangle_inferred[i]);
  }
  gather_vertices(mesh, kept, part);
  return part;
}

}  // namespace dubsar
