#include "core/relief/smoothing/corner_weights.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {
constexpr float kGuard = 1e-6f;  // both edges shorter than 0.03 grid steps: too short to trust
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

}  // namespace dubsar
