#include "core/relief/corner_weights.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"

namespace dubsar {
namespace {
constexpr std::int64_t kGrain = 16384;
constexpr float kGuard = 1e-6f;  // both edges shorter than 0.03 grid steps: too short to trust

/// The four corners at once, with the sums and products of corner_weight() in its order.
std::array<float, 4> weights_of(const std::array<glm::vec3, 4>& p) {
  std::array<float, 4> x, y, z, length2, weight;  // of the edges: from corner c to the next
  for (std::size_t c = 0; c < 4; ++c) {
    const glm::vec3 edge = p[(c + 1) % 4] - p[c];
    x[c] = edge.x;
    y[c] = edge.y;
    z[c] = edge.z;
  }
  std::array<float, 4> bx, by, bz, before2;  // back from corner c
  for (std::size_t c = 0; c < 4; ++c) length2[c] = x[c] * x[c] + y[c] * y[c] + z[c] * z[c];
  for (std::size_t c = 0; c < 4; ++c) {
    bx[c] = -x[(c + 3) % 4];
    by[c] = -y[(c + 3) % 4];
    bz[c] = -z[(c + 3) % 4];
    before2[c] = length2[(c + 3) % 4];
  }
  for (std::size_t c = 0; c < 4; ++c) {
    const float nx = y[c] * bz[c] - by[c] * z[c], ny = z[c] * bx[c] - bz[c] * x[c], nz = x[c] * by[c] - bx[c] * y[c];
    weight[c] = std::sqrt(nx * nx + ny * ny + nz * nz) / (length2[c] * before2[c] + kGuard);
  }
  return weight;
}
}  // namespace

float corner_weight(const QuadMesh& mesh, std::uint32_t quad, std::uint32_t vertex) {
  const Polygon polygon = mesh.polygon(quad);
  const auto size = static_cast<std::size_t>(polygon.size);
  std::uint32_t before = vertex, after = vertex;
  for (std::size_t k = 0; k < size; ++k)
    if (polygon.vertex[k] == vertex) {
      before = polygon.vertex[(k + size - 1) % size];
      after = polygon.vertex[(k + 1) % size];
      break;
    }
  const glm::vec3 p = mesh.positions[vertex], a = mesh.positions[after] - p, b = mesh.positions[before] - p;
  return glm::length(glm::cross(a, b)) / (glm::dot(a, a) * glm::dot(b, b) + kGuard);
}

std::vector<std::array<float, 4>> corner_weights(const QuadMesh& mesh) {
  std::vector<std::array<float, 4>> weights(mesh.quads.size());
  parallel_for(mesh.quad_count(), kGrain, [&](std::int64_t i) {
    const auto q = static_cast<std::size_t>(i);
    const auto& quad = mesh.quads[q];
    weights[q] = weights_of(
        {mesh.positions[quad[0]], mesh.positions[quad[1]], mesh.positions[quad[2]], mesh.positions[quad[3]]});
  });
  return weights;
}

}  // namespace dubsar
