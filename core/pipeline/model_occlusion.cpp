#include "core/pipeline/model_occlusion.h"

#include <algorithm>
#include <array>

namespace dubsar {
namespace {

/// Partition ids to the first id of the same part: the two walls of an envelope are one body.
std::array<std::uint8_t, 8> body_of_partition(const std::vector<Partition>& partitions) {
  std::array<std::uint8_t, 8> body{};
  for (std::size_t i = 0; i < partitions.size() && i < body.size(); ++i) {
    body[i] = static_cast<std::uint8_t>(i);
    for (std::size_t j = i; j-- > 0;)
      if (!partitions[i].part.empty() && partitions[j].part == partitions[i].part)
        body[i] = static_cast<std::uint8_t>(j);
  }
  return body;
}

}  // namespace

Result<void> occlusion_of_model(SurfaceModel& model, OcclusionOptions options, Progress& progress) {
  model.attributes.ao.clear();
  std::vector<std::uint32_t> source;
  DUBSAR_ASSIGN(const TriMesh mesh, make_tri_mesh(model, {}, &source));
  std::vector<std::uint8_t> body = mesh.partition;
  const auto body_of = body_of_partition(model.partitions);
  for (std::uint8_t& id : body) id = body_of[id & 7];
  options.partition = body;
  DUBSAR_ASSIGN(const std::vector<std::uint8_t> light,
                ambient_occlusion(mesh.positions, mesh.normals, mesh.triangles, options, progress));
  std::vector<std::uint8_t> ao(model.mesh.positions.size(), 0);
  for (std::size_t i = 0; i < source.size(); ++i)
    if (source[i] != kNoSource) ao[source[i]] = std::max(ao[source[i]], light[i]);
  model.attributes.ao = std::move(ao);
  return {};
}

}  // namespace dubsar
