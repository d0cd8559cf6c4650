#include "core/mesh_io/mesh_output.h"

#include "core/mesh/vertex_attributes.h"
#include "core/relief/curvature/shape_colors.h"

namespace dubsar {

Result<void> check_tri_mesh(const TriMesh& mesh) {
  DUBSAR_TRY(check_arrays(mesh, ErrorKind::kInternal, "mesh"));
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
