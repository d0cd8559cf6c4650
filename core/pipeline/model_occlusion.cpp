#include "core/pipeline/model_occlusion.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace dubsar {
namespace {

/// The triangles of the model with normals, and without what light does not ask for: memory is scarcest here.
Result<TriMesh> mesh_to_light(SurfaceModel& model, Progress& progress, std::vector<std::uint32_t>& source) {
  VertexAttributes all = std::move(model.attributes);
  model.attributes = {};
  model.attributes.normals = std::move(all.normals);
  Result<TriMesh> mesh = make_tri_mesh(model, {.progress = &progress}, &source);
  all.normals = std::move(model.attributes.normals);
  model.attributes = std::move(all);
  return mesh;
}

/// Triangles of one body after those of another, each in the order that they had.
void put_bodies_together(std::vector<Triangle>& triangles, std::vector<PartitionId>& bodies) {
  std::array<std::size_t, 256> next{};
  for (const PartitionId id : bodies) ++next[id];
  std::exclusive_scan(next.begin(), next.end(), next.begin(), std::size_t{0});
  std::vector<Triangle> sorted(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) sorted[next[bodies[t]]++] = triangles[t];
  std::sort(bodies.begin(), bodies.end());
  triangles = std::move(sorted);
}

}  // namespace

Result<void> occlusion_of_model(SurfaceModel& model, const OcclusionOptions& options, Progress& progress) {
  model.attributes.ao = {};
  std::vector<std::uint32_t> source;
  DUBSAR_ASSIGN(TriMesh mesh, mesh_to_light(model, progress, source));
  std::array<PartitionId, PartitionTable::kMost> body_of{};
  for (const Partition& p : model.partitions) body_of[p.id] = model.partitions.body_of(p.id);
  std::vector<PartitionId> bodies = std::move(mesh.triangle_partition);  // the two walls of an envelope are one body
  for (PartitionId& id : bodies) id = body_of[id];
  put_bodies_together(mesh.triangles, bodies);
  DUBSAR_ASSIGN(const std::vector<std::uint8_t> light,
                ambient_occlusion({mesh.positions, mesh.normals, mesh.triangles, bodies}, options, progress));
  mesh = {};
  std::vector<std::uint8_t> ao(model.mesh.positions.size(), 0);
  for (std::size_t i = 0; i < source.size(); ++i)
    if (source[i] != kNoSource) ao[source[i]] = std::max(ao[source[i]], light[i]);
  model.attributes.ao = std::move(ao);
  return {};
}

}  // namespace dubsar
