#include "core/mesh_io/mesh_output.h"

#include <glm/common.hpp>

#include "core/base/system/log.h"
#include "core/mesh/vertex_attributes.h"
#include "core/relief/curvature/shape_colors.h"

namespace dubsar {

glm::dvec3 OutputSpace::far_origin(const TriMesh& mesh) const {
  constexpr double kFar = 64.0;  // extents: float keeps 1/260 000 of the extent there
  if (mesh.positions.empty()) return glm::dvec3(0.0);
  glm::dvec3 low(exact_position(mesh.positions.front())), high(low);
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, exact_position(p));
    high = glm::max(high, exact_position(p));
  }
  const glm::dvec3 size = high - low, reach = glm::max(glm::abs(low), glm::abs(high));
  const double extent = std::max({size.x, size.y, size.z});
  if (!(extent > 0) || std::max({reach.x, reach.y, reach.z}) <= kFar * extent) return glm::dvec3(0.0);
  return glm::round(0.5 * (low + high));
}

glm::dvec3 OutputSpace::told_origin(const TriMesh& mesh, std::string_view format) const {
  const glm::dvec3 origin = far_origin(mesh);
  if (origin != glm::dvec3(0.0))
    log_warning(
        "{}: the surface lies at {:.0f}, {:.0f}, {:.0f}, where the format's numbers are too coarse for it: it is "
        "written relative to that place",
        format, origin.x, origin.y, origin.z);
  return origin;
}

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
