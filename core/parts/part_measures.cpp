#include <array>
#include <glm/geometric.hpp>
#include <optional>

#include "core/base/system/parallel.h"
#include "core/mesh/mesh_check.h"
#include "core/parts/surface_model.h"
#include "core/parts/triangle_soup.h"

namespace dubsar {

namespace {

struct Sums {
  double area = 0.0, volume = 0.0;
};
using SumsOfParts = std::array<Sums, std::size_t{PartitionTable::kHighest} + 1>;

/// Area and signed volume of the triangles of each partition, over cones from `origin`.
SumsOfParts sum_parts(const TriMesh& mesh, const glm::dvec3& origin) {
  const glm::dvec3 step_mm = mesh.frame.grid_voxel_mm();
  SumsOfParts sums = parallel_reduce<SumsOfParts>(
      static_cast<std::int64_t>(mesh.triangles.size()), 1 << 16, {},
      [&](std::int64_t begin, std::int64_t end) {
        SumsOfParts part{};
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) {
          const Triangle& triangle = mesh.triangles[t];
          const auto corner = [&](std::size_t c) {
            return (glm::dvec3(mesh.positions[triangle[c]]) - origin) * step_mm;
          };
          const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
          Sums& s = part[mesh.partition_of(t)];
          s.area += 0.5 * glm::length(glm::cross(b - a, c - a));
          s.volume += glm::dot(a, glm::cross(b, c)) / 6.0;
        }
        return part;
      },
      [](SumsOfParts a, const SumsOfParts& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] = {a[i].area + b[i].area, a[i].volume + b[i].volume};
        return a;
      });
  if (step_mm.x * step_mm.y * step_mm.z < 0.0)
    for (Sums& s : sums) s.volume = -s.volume;
  return sums;
}

/// Of the vertices where partitions of one body meet.
std::optional<glm::dvec3> middle_of_cracks(const SurfaceModel& model) {
  std::vector<std::uint8_t> own, body;
  for (const Partition& p : model.partitions) {
    own.push_back(p.id);
    body.push_back(model.partitions.body_of(p.id));
  }
  const std::vector<std::uint8_t> all = border_vertices(model, own), between = border_vertices(model, body);
  glm::dvec3 sum(0.0);
  double count = 0.0;
  for (std::size_t v = 0; v < all.size(); ++v) {
    if (all[v] == between[v]) continue;
    sum += glm::dvec3(model.mesh.positions[v]);
    count += 1.0;
  }
  return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace

MeshMeasure measure_mesh(const TriMesh& mesh) {
  if (mesh.positions.empty()) return {};
  MeshMeasure measure;
  for (const Sums& s : sum_parts(mesh, mesh.positions.front())) {  // near the surface: the volume does not cancel
    measure.area_mm2 += s.area;
    measure.volume_mm3 += s.volume;
  }
  measure.watertight = check_mesh(mesh.positions, mesh.triangles).watertight();
  return measure;
}

Result<void> measure_partitions(SurfaceModel& model) {
  if (model.partitions.empty()) return {};
  DUBSAR_ASSIGN(const TriMesh mesh, make_tri_mesh(model, {.separate_partitions = true, .attributes = false}));
  if (mesh.positions.empty()) {
    for (std::size_t row = 0; row < model.partitions.size(); ++row)
      model.partitions.measured(model.partitions[row].id, 0.0, 0.0, false);
    return {};
  }
  const SumsOfParts sums = sum_parts(mesh, middle_of_cracks(model).value_or(mesh.positions.front()));
  const std::vector<bool> watertight = watertight_parts(mesh.positions.size(), mesh.triangles, mesh.triangle_partition);
  for (std::size_t row = 0; row < model.partitions.size(); ++row) {
    const PartitionId id = model.partitions[row].id;
    model.partitions.measured(id, sums[id].area, sums[id].volume, watertight[id]);
  }
  return {};
}

}  // namespace dubsar
