#include "core/relief/smoothing/fair_moves.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kFairGrain = 8192;
constexpr int kNormalSteps = 2;
constexpr double kLeastArea = 0.1;  ///< squared grid steps; below it areas around a vertex cancel

/// Half of the cross products of neighbouring corners: the area of an x-quad as a vector, towards the air.
glm::dvec3 area_of(const QuadMesh& mesh, const Polygon& polygon) {
  const auto at = [&](int i) {
    return glm::dvec3(mesh.positions[polygon.vertex[static_cast<std::size_t>(i % polygon.size)]]);
  };
  const glm::dvec3 origin = at(0);
  glm::dvec3 twice(0.0);
  for (int i = 1; i + 1 < polygon.size; ++i) twice += glm::cross(at(i) - origin, at(i + 1) - origin);
  return 0.5 * twice;
}

/// Takes vectors at the vertices of a mesh to the means of those around. Sums are of doubles, which hold those of a few
/// floats without a loss: their order, in which the axes stand, does not matter.
class MeanSteps {
 public:
  explicit MeanSteps(const QuadMesh& mesh) : mesh_(mesh), centres_(mesh.quads.size()) {}

  /// The mean areas of the x-quads around vertices.
  std::vector<glm::vec3> areas() {
    each_quad([&](const Polygon& polygon) { return area_of(mesh_, polygon); });
    std::vector<glm::vec3> values(mesh_.positions.size(), glm::vec3(0.0f));
    gather(values);
    return values;
  }
  void step(std::vector<glm::vec3>& values) {
    each_quad([&](const Polygon& polygon) {
      glm::dvec3 sum(0.0);
      for (int i = 0; i < polygon.size; ++i) sum += glm::dvec3(values[polygon.vertex[static_cast<std::size_t>(i)]]);
      return sum / static_cast<double>(polygon.size);
    });
    gather(values);
  }

 private:
  template <class Value>
  void each_quad(const Value& value) {
    parallel_for(mesh_.quad_count(), kFairGrain, [&](std::int64_t q) {
      centres_[static_cast<std::size_t>(q)] = glm::vec3(value(mesh_.polygon(static_cast<std::uint32_t>(q))));
    });
  }
  void gather(std::vector<glm::vec3>& values) const {
    parallel_for(mesh_.vertex_count(), kFairGrain, [&](std::int64_t v) {
      const auto quads = mesh_.quads_of(static_cast<std::uint32_t>(v));
      if (quads.empty()) return;
      glm::dvec3 sum(0.0);
      for (const std::uint32_t q : quads) sum += glm::dvec3(centres_[q]);
      values[static_cast<std::size_t>(v)] = glm::vec3(sum / static_cast<double>(quads.size()));
    });
  }

  const QuadMesh& mesh_;
  std::vector<glm::vec3> centres_;
};

}  // namespace

Result<std::vector<glm::vec3>> fair_moves(const QuadMesh& mesh, const FairOptions& options, Progress& progress) {
  DUBSAR_CHECK(options.near_steps > 0 && options.wide_steps > options.near_steps);
  MeanSteps means(mesh);
  std::vector<glm::vec3> normals = means.areas(), near = mesh.positions;
  for (int i = 0; i < kNormalSteps; ++i) means.step(normals);
  for (int i = 0; i < options.near_steps; ++i) means.step(near);
  if (progress.cancelled()) return cancelled_error();
  std::vector<glm::vec3> moves = near;  // the wide mean, until it is known
  for (int i = options.near_steps; i < options.wide_steps; ++i) {
    if (progress.cancelled()) return cancelled_error();
    means.step(moves);
  }
  // A Gauss of variance v takes v H off a surface of mean curvature H, as it does off the ball's radius.
  const double near_steps = options.near_steps, wider_steps = options.wide_steps - options.near_steps,
               growth = options.growth, most = options.most_move;
  parallel_for(mesh.vertex_count(), kFairGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    const glm::dvec3 normal(normals[v]), close(near[v]), wide(moves[v]);
    const double area = glm::length(normal);
    moves[v] = glm::vec3(0.0f);
    if (!(area > kLeastArea)) return;
    const double step = FairOptions::kStepVariance * area,
                 sharpen = (near_steps * step + growth) / (wider_steps * step);
    const double along = glm::dot(close + sharpen * (close - wide) - glm::dvec3(mesh.positions[v]), normal) / area;
    moves[v] = glm::vec3(std::clamp(along, -most, most) / area * normal);
  });
  return moves;
}

}  // namespace dubsar
