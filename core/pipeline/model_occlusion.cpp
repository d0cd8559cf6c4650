#include "core/pipeline/model_occlusion.h"

#include <algorithm>
#include <array>

namespace dubsar {

Result<void> occlusion_of_model(SurfaceModel& model, const OcclusionOptions& options, Progress& progress) {
  model.attributes.ao.clear();
  std::vector<std::uint32_t> source;
  DUBSAR_ASSIGN(const TriMesh mesh, make_tri_mesh(model, {.progress = &progress}, &source));
  std::array<PartitionId, PartitionTable::kMost> body_of{};
  for (const Partition& p : model.partitions) body_of[p.id] = model.partitions.body_of(p.id);
  std::vector<PartitionId> bodies = mesh.triangle_partition;  // the two walls of an envelope are one body
  for (PartitionId& id : bodies) id = body_of[id];
  DUBSAR_ASSIGN(const std::vector<std::uint8_t> light,
                ambient_occlusion({mesh.positions, mesh.normals, mesh.triangles, bodies}, options, progress));
  std::vector<std::uint8_t> ao(model.mesh.positions.size(), 0);
  for (std::size_t i = 0; i < source.size(); ++i)
    if (source[i] != kNoSource) ao[source[i]] = std::max(ao[source[i]], light[i]);
  model.attributes.ao = std::move(ao);
  return {};
}

}  // namespace dubsar
