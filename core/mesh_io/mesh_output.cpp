#include "core/mesh_io/mesh_output.h"

#include "core/relief/shape_colors.h"

namespace dubsar {

Result<void> check_tri_mesh(const TriMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  const auto fits = [&](std::size_t size) { return size == 0 || size == count; };
  if (!fits(mesh.normals.size()) || !fits(mesh.k_min.size()) || !fits(mesh.k_max.size()) || !fits(mesh.shape.size()) ||
      !fits(mesh.ao.size()) || !fits(mesh.colors.size()))
    return fail(ErrorKind::kInternal, "mesh: vertex arrays of different lengths, expected {} entries each", count);
  if (!mesh.triangle_partition.empty() && mesh.triangle_partition.size() != mesh.triangles.size())
    return fail(ErrorKind::kInternal, "mesh: {} partition ids found, expected one for each of {} triangles",
                mesh.triangle_partition.size(), mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= count) return fail(ErrorKind::kInternal, "mesh: vertex {} named, but there are {}", v, count);
  for (const glm::vec3& p : mesh.positions)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return fail(ErrorKind::kBadData, "mesh: a vertex position is not finite, so the mesh is not written");
  return {};
}

VertexColors output_colors(const TriMesh& mesh) {
  if (!mesh.colors.empty() || (mesh.shape.empty() && mesh.ao.empty())) return {mesh.colors, false};
  return {shape_vertex_colors(ShapeColors::kTable, mesh.shape, mesh.ao), true};
}

std::string partition_name(const TriMesh& mesh, PartitionId id) {
  const Partition* const partition = mesh.partitions.find(id);
  return partition != nullptr && !partition->name.empty() ? partition->name : fmt::format("part {}", id);
}

}  // namespace dubsar
