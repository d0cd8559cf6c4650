#include "core/parts/fill/rim_normals.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr double kLeastFaces = 60.0;    ///< about 4 rings on one side of a border
constexpr double kSurfaceShare = 4e-4;  ///< of all faces: farther from the rim a tablet has bent
constexpr float kLeastSum = 0.5f;       ///< shortest sum of two unit normals whose mean says something

/// Of half a disk behind the middle of a straight rim, as wide as a round hole with such a loop.
std::size_t faces_behind(std::size_t loop, std::uint32_t faces) {
  constexpr double kPi = 3.14159265;
  const double radius = static_cast<double>(loop) / (2.0 * kPi);
  const double most = std::max(kLeastFaces, kSurfaceShare * static_cast<double>(faces));
  return static_cast<std::size_t>(std::clamp(0.5 * kPi * radius * radius, kLeastFaces, most));
}

/// Looks at the surface behind edges of one loop.
class Behind {
 public:
  Behind(const SurfaceModel& model, const FaceGraph& graph, std::span<const PartitionId> bodies, std::size_t faces)
      : model_(model), graph_(graph), bodies_(bodies), most_(faces), seen_(graph.faces(), false) {}

  glm::vec3 continued(const BorderEdge& edge) {
    const glm::vec3 near = mean_normal(edge.face);
    const auto is = [&](PartitionId id, PartitionKind kind) { return model_.partitions.find(id)->kind == kind; };
    if (!is(edge.left, PartitionKind::kTablet) || !is(edge.right, PartitionKind::kEnvelopeInside)) return near;
    const glm::vec3 both = near - mean_normal(edge.beyond);
    return glm::length(both) > kLeastSum ? glm::normalize(both) : near;
  }

 private:
  /// Of the faces of its body around a face, ring by ring.
  glm::vec3 mean_normal(std::uint32_t face) {
    const PartitionId body = body_of(face);
    glm::vec3 sum(0.0f);
    queue_.assign(1, face);
    seen_[face] = true;
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const std::uint32_t f = queue_[i];
      sum += graph_.area[f] * graph_.normal[f];
      for (std::uint32_t s = graph_.first_side[f]; s < graph_.first_side[f + 1] && queue_.size() < most_; ++s) {
        const std::uint32_t g = graph_.neighbour[s];
        if (g == FaceGraph::kNone || seen_[g] || body_of(g) != body) continue;
        seen_[g] = true;
        queue_.push_back(g);
      }
    }
    for (const std::uint32_t f : queue_) seen_[f] = false;
    const float length = glm::length(sum);
    return length > 0.0f ? sum / length : glm::vec3(0.0f);
  }
  PartitionId body_of(std::uint32_t face) const { return bodies_[model_.quad_partition[face]]; }

  const SurfaceModel& model_;
  const FaceGraph& graph_;
  std::span<const PartitionId> bodies_;
  std::size_t most_;
  std::vector<bool> seen_;
  std::vector<std::uint32_t> queue_;
};

}  // namespace

std::vector<glm::vec3> rim_normals(const SurfaceModel& model, const FaceGraph& graph,
                                   std::span<const PartitionId> bodies, std::span<const BorderEdge> edges,
                                   std::span<const std::uint32_t> loop) {
  constexpr double kSteps = 8.0;  // of a mean's radius from one that is found to the next; between, they are mixed
  constexpr std::int64_t kGrain = 8;
  const std::size_t faces = faces_behind(loop.size(), graph.faces());
  const auto stride = static_cast<std::size_t>(std::max(1.0, std::sqrt(static_cast<double>(faces)) / kSteps));
  const std::size_t found = (loop.size() + stride - 1) / stride;
  std::vector<glm::vec3> known(found);
  parallel_chunks(static_cast<std::int64_t>(found), kGrain, [&](std::int64_t begin, std::int64_t end) {
    Behind behind(model, graph, bodies, faces);
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      known[k] = behind.continued(edges[loop[k * stride]]);
  });
  if (std::find(known.begin(), known.end(), glm::vec3(0.0f)) != known.end()) return {};
  std::vector<glm::vec3> normals(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t k = i / stride, first = k * stride, next = std::min(first + stride, loop.size());
    const glm::vec3 mixed =
        glm::mix(known[k], known[(k + 1) % found], static_cast<float>(i - first) / static_cast<float>(next - first));
    const float length = glm::length(mixed);
    if (!(length > 0.0f)) return {};
    normals[i] = mixed / length;
  }
  return normals;
}

}  // namespace dubsar
