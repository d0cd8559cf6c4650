#include "core/relief/curvature/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/relief/smoothing/quad_sums.h"
#include "core/relief/smoothing/scatter_blocks.h"

namespace dubsar {
namespace {

constexpr std::int64_t kCurvatureGrain = 8192;

struct Corners {
  std::array<glm::vec3, 4> position, normal;
};

Corners corners_of(const QuadMesh& mesh, std::span<const glm::vec3> normals, std::uint32_t quad) {
  Corners corners;
  const auto& ids = mesh.quads[quad];
  for (std::size_t c = 0; c < 4; ++c) {
    corners.position[c] = mesh.positions[ids[c]];
    corners.normal[c] = normals[ids[c]];
  }
  if (mesh.has_doubled(quad)) {
    const Polygon polygon = mesh.polygon(quad);
    for (std::size_t i = 1; i < static_cast<std::size_t>(polygon.size); ++i) {
      const std::size_t c = polygon.corner[i];
      if (c != polygon.corner[i - 1]) continue;
      corners.position[c] = 0.5f * (corners.position[c] + mesh.positions[polygon.vertex[i]]);
      corners.normal[c] = 0.5f * (corners.normal[c] + normals[polygon.vertex[i]]);
    }
  }
  return corners;
}

glm::vec2 diagonal_extremes(const QuadMesh& mesh, std::span<const glm::vec3> normals, std::uint32_t quad) {
  const Corners corners = corners_of(mesh, normals, quad);
  std::array<float, 2> k{};
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::vec3 p = corners.position[i + 2] - corners.position[i], n = corners.normal[i + 2] - corners.normal[i];
    const float length2 = glm::dot(p, p);
    k[i] = length2 > 1e-12f ? glm::dot(n, p) / length2 : 0.0f;
  }
  return {std::min(k[0], k[1]), std::max(k[0], k[1])};
}

/// Vector median of (k_min, k_max) over the incident x-quads by Weiszfeld steps from the mean. A mean with positive
/// weights of pairs with k_min <= k_max keeps that order.
glm::vec2 median_pair(std::span<const std::uint32_t> quads, std::span<const glm::vec2> pairs) {
  constexpr int kSteps = 8;
  constexpr float kEpsilon = 1e-3f;  // per grid step; far below the smallest curvedness that is not flat, 1/64
  glm::vec2 median(0.0f);
  if (quads.empty()) return median;
  for (const std::uint32_t quad : quads) median += pairs[quad];
  median /= static_cast<float>(quads.size());
  for (int step = 0; step < kSteps; ++step) {
    glm::vec2 sum(0.0f);
    float weights = 0.0f;
    for (const std::uint32_t quad : quads) {
      const float weight = 1.0f / (glm::length(pairs[quad] - median) + kEpsilon);
      sum += weight * pairs[quad];
      weights += weight;
    }
    median = sum / weights;
  }
  return {std::min(median.x, median.y), std::max(median.x, median.y)};
}

}  // namespace

Result<Curvatures> principal_curvatures(const QuadMesh& mesh, std::span<const glm::vec3> normals,
                                        CurvatureMethod method, Progress& progress) {
  DUBSAR_CHECK(normals.size() == mesh.positions.size());
  progress.begin("curvature", mesh.vertex_count(), "vertex");
  Curvatures result;
  resize_large(result.k_min, normals.size());
  resize_large(result.k_max, normals.size());
  if (method == CurvatureMethod::kFit && !normals.empty()) {
    scatter_to_vertices(mesh, kFitFloats, [&](float* rows, std::int64_t first, std::int64_t size, const auto& groups) {
      if (progress.cancelled()) return;
      const VertexSums sums{&mesh,
                            nullptr,
                            &normals.front().x,
                            rows,
                            static_cast<std::uint32_t>(first),
                            static_cast<std::uint32_t>(size)};
      for (const std::uint32_t group : groups) add_fit_moments(sums, group);
      finish_fit(sums, result.k_min.data(), result.k_max.data());
      progress.advance(size);
    });
  }
  if (method == CurvatureMethod::kPairs) {
    std::vector<glm::vec2> pairs(mesh.quads.size());
    parallel_for(mesh.quad_count(), kCurvatureGrain, [&](std::int64_t q) {
      pairs[static_cast<std::size_t>(q)] = diagonal_extremes(mesh, normals, static_cast<std::uint32_t>(q));
    });
    parallel_chunks(mesh.vertex_count(), kCurvatureGrain, [&](std::int64_t begin, std::int64_t end) {
      if (progress.cancelled()) return;
      for (std::int64_t i = begin; i < end; ++i) {
        const auto v = static_cast<std::size_t>(i);
        const glm::vec2 k = median_pair(mesh.quads_of(static_cast<std::uint32_t>(v)), pairs);
        result.k_min[v] = k.x;
        result.k_max[v] = k.y;
      }
      progress.advance(end - begin);
    });
  }
  if (progress.cancelled()) return cancelled_error();
  progress.end();
  return result;
}

}  // namespace dubsar
