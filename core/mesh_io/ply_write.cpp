#include <algorithm>
#include <limits>

#include "core/base/files/buffered_writer.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/mesh_text.h"
#include "core/mesh_io/progress_step.h"

namespace dubsar {
namespace {

void append(std::string& row, const glm::vec3& v) {
  append_little(row, v.x);
  append_little(row, v.y);
  append_little(row, v.z);
}

/// For viewers that colour vertices: the lowest partition of the triangles around each. The truth is at the faces.
std::vector<PartitionId> vertex_labels(const TriMesh& mesh) {
  std::vector<PartitionId> labels(mesh.positions.size(), PartitionTable::kNone);
  for (std::size_t t = 0; t < mesh.triangle_partition.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) labels[v] = std::min(labels[v], mesh.triangle_partition[t]);
  std::replace(labels.begin(), labels.end(), PartitionTable::kNone, PartitionId{0});
  return labels;
}
}  // namespace

Result<void> write_ply(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress) {
  DUBSAR_TRY(check_tri_mesh(mesh));
  if (mesh.positions.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    return fail(ErrorKind::kUsage, "ply: {} vertices do not fit 31-bit indices; export one partition at a time",
                mesh.positions.size());
  const VertexColors colors = output_colors(mesh);
  const bool derived = colors.derived || options.colors_derived;
  const bool normals = !mesh.normals.empty(), curvatures = !mesh.k_min.empty() && !mesh.k_max.empty();

  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& line : mesh_text_lines(mesh, options, derived)) header += "comment " + line + "\n";
  std::size_t vertex_bytes = 0;
  const auto declare = [&](bool present, std::string_view type, std::size_t bytes,
                           std::initializer_list<std::string_view> names) {
    if (!present) return;
    for (const std::string_view name : names) header += fmt::format("property {} {}\n", type, name);
    vertex_bytes += bytes * names.size();
  };
  header += fmt::format("element vertex {}\n", mesh.positions.size());
  const OutputSpace space(mesh.frame, options.units);
  const bool far = space.far_origin(mesh) != glm::dvec3(0.0);
  declare(true, far ? "double" : "float", far ? 8 : 4, {"x", "y", "z"});
  declare(normals, "float", 4, {"nx", "ny", "nz"});
  declare(!colors.rgb.empty(), "uchar", 1, {"red", "green", "blue"});
  declare(!mesh.triangle_partition.empty(), "uchar", 1, {"partition"});
  declare(curvatures, "float", 4, {"k_min", "k_max"});
  declare(!mesh.shape.empty(), "uchar", 1, {"shape"});
  declare(!mesh.ao.empty(), "uchar", 1, {"ao"});
  declare(!mesh.evidence.empty(), "uchar", 1, {"evidence"});
  declare(curvatures, "float", 4, {"quality"});
  header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", mesh.triangles.size());
  const bool labelled = !mesh.triangle_partition.empty();
  header += labelled ? "property uchar partition\nend_header\n" : "end_header\n";

  const std::size_t triangle_bytes = labelled ? 14 : 13;
  const std::size_t bytes =
      header.size() + vertex_bytes * mesh.positions.size() + triangle_bytes * mesh.triangles.size();
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path, static_cast<std::int64_t>(bytes)));
  BufferedWriter out(file);
  out.text(header);
  const std::vector<PartitionId> labels = vertex_labels(mesh);
  progress.begin("write ply", static_cast<std::int64_t>(mesh.positions.size() + mesh.triangles.size()), "item");
  std::string row;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    row.clear();
    if (const glm::dvec3 p = space.exact_position(mesh.positions[v]); far)
      for (int axis = 0; axis < 3; ++axis) append_little(row, p[axis]);
    else
      append(row, glm::vec3(p));
    if (normals) append(row, space.normal(mesh.normals[v]));
    if (!colors.rgb.empty())
      for (const std::uint8_t c : colors.rgb[v]) append_little(row, c);
    if (labelled) append_little(row, labels[v]);
    const float k_min = curvatures ? space.curvature(mesh.k_min[v]) : 0.0f;
    const float k_max = curvatures ? space.curvature(mesh.k_max[v]) : 0.0f;
    if (curvatures) append_little(row, k_min), append_little(row, k_max);
    if (!mesh.shape.empty()) append_little(row, mesh.shape[v]);
    if (!mesh.ao.empty()) append_little(row, mesh.ao[v]);
    if (!mesh.evidence.empty()) append_little(row, mesh.evidence[v]);
    if (curvatures) append_little(row, 0.5f * (k_min + k_max));
    out.text(row);
    if ((v + 1) % kProgressStep == 0) {
      progress.advance(kProgressStep);
      if (progress.cancelled()) return cancelled_error();
      if (!out.ok()) return out.flush();
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    row.assign(1, '\3');
    for (const std::uint32_t v : mesh.triangles[t]) append_little(row, v);
    if (labelled) append_little(row, mesh.triangle_partition[t]);
    out.text(row);
    if ((t + 1) % kProgressStep == 0) {
      progress.advance(kProgressStep);
      if (progress.cancelled()) return cancelled_error();
      if (!out.ok()) return out.flush();
    }
  }
  DUBSAR_TRY(out.flush());
  DUBSAR_TRY(file.commit());
  progress.end();
  return {};
}

}  // namespace dubsar
