// The paper's segmentation (section 3.4.3): cut the surface where it is concave, take what hangs together.

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"
#include "core/parts/face_roles.h"

namespace dubsar {
namespace {

/// Smaller of the curvatures along the two diagonals of an x-quad; a doubled corner counts with its mean.
float smallest_diagonal_curvature(const SurfaceModel& model, std::uint32_t quad) {
  const Polygon polygon = model.mesh.polygon(quad);
  std::array<glm::vec3, 4> position{}, normal{};
  std::array<float, 4> count{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i) {
    const std::size_t c = polygon.corner[i];
    position[c] += model.mesh.positions[polygon.vertex[i]];
    normal[c] += model.attributes.normals[polygon.vertex[i]];
    count[c] += 1.0f;
  }
  for (std::size_t c = 0; c < 4; ++c) {
    position[c] /= count[c];
    normal[c] /= count[c];
  }
  float smallest = 0.0f;
  for (std::size_t c = 0; c < 2; ++c) {
    const glm::vec3 d = position[c + 2] - position[c];
    const float length2 = glm::dot(d, d);
    if (length2 > 1e-12f) smallest = std::min(smallest, glm::dot(normal[c + 2] - normal[c], d) / length2);
  }
  return smallest;
}

}  // namespace

Result<std::vector<FaceRole>> roles_by_concavity(const SurfaceModel& model, const FaceScene& scene,
                                                 const SegmentOptions& options, Progress& progress) {
  const QuadMesh& mesh = model.mesh;
  const std::uint32_t faces = scene.graph.faces();
  if (model.attributes.normals.size() != mesh.positions.size())
    return fail(ErrorKind::kBadData,
                "segment: {} vertex normals found, the concavity method needs one for each of {} vertices",
                model.attributes.normals.size(), mesh.positions.size());
  std::vector<std::uint8_t> concave(faces);
  parallel_for(faces, 1 << 13, [&](std::int64_t f) {
    concave[static_cast<std::size_t>(f)] =
        smallest_diagonal_curvature(model, static_cast<std::uint32_t>(f)) < options.concavity;
  });
  // Faces with a vertex within `dilate_rings` rings of a concave face are cut away.
  std::vector<std::uint8_t> grown(faces);
  for (int ring = 0; ring <= options.dilate_rings; ++ring) {
    if (progress.cancelled()) return cancelled_error();
    parallel_for(faces, 1 << 13, [&](std::int64_t f) {
      const Polygon polygon = mesh.polygon(static_cast<std::uint32_t>(f));
      bool any = false;
      for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size) && !any; ++i)
        for (const std::uint32_t q : mesh.quads_of(polygon.vertex[i])) any = any || concave[q];
      grown[static_cast<std::size_t>(f)] = any;
    });
    concave = grown;
  }
  const FaceComponents components = find_components(model, scene, concave);

  // The cut grows back from both sides until it is one line.
  std::vector<std::uint32_t> owner(faces, FaceGraph::kNone), queue;
  for (std::uint32_t f = 0; f < faces; ++f)
    if (!concave[f]) {
      owner[f] = components.of_face[f];
      queue.push_back(f);
    }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const std::uint32_t f = queue[i];
    for (std::uint32_t s = scene.graph.first_side[f]; s < scene.graph.first_side[f + 1]; ++s) {
      const std::uint32_t g = scene.graph.neighbour[s];
      if (g == FaceGraph::kNone || owner[g] != FaceGraph::kNone) continue;
      owner[g] = owner[f];
      queue.push_back(g);
    }
  }
  std::vector<FaceRole> role_of(components.info.size());
  for (std::size_t c = 0; c < role_of.size(); ++c) {
    const FaceComponents::Info& info = components.info[c];
    const bool outside = info.exterior_area > 0.5 * info.area;
    role_of[c] = outside ? FaceRole::kOutside : info.inward_area > 0.0 ? FaceRole::kInside : FaceRole::kCore;
  }
  std::vector<FaceRole> roles(faces, FaceRole::kInside);
  for (std::uint32_t f = 0; f < faces; ++f)
    roles[f] = role_of[owner[f] != FaceGraph::kNone ? owner[f] : components.of_face[f]];
  return roles;
}

}  // namespace dubsar
