#include "core/relief/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/parallel.h"

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

/// Sums of the normal equations of min sum |S u - d|^2, S = [a b; b c].
class ShapeOperatorFit {
 public:
  void add(glm::vec2 u, glm::vec2 d) {
    uu_ += u.x * u.x;
    uv_ += u.x * u.y;
    vv_ += u.y * u.y;
    a_ += u.x * d.x;
    b_ += u.x * d.y + u.y * d.x;
    c_ += u.y * d.y;
  }
  /// Eigenvalues of S, smaller first.
  glm::vec2 principal() const {
    // The small ridge keeps collinear differences solvable (S is then 0 across them); relative error 1e-5.
    const double ridge = 1e-5 * (static_cast<double>(uu_) + static_cast<double>(vv_));
    if (!(ridge > 0.0)) return glm::vec2(0.0f);
    const double uu = static_cast<double>(uu_) + ridge, vv = static_cast<double>(vv_) + ridge;
    const double uv = static_cast<double>(uv_), x = static_cast<double>(a_), z = static_cast<double>(c_);
    const double b = (static_cast<double>(b_) - uv * (x / uu + z / vv)) / ((uu + vv) * (1.0 - uv * uv / (uu * vv)));
    const double a = (x - b * uv) / uu, c = (z - b * uv) / vv;
    const double mean = 0.5 * (a + c), half = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
    return {static_cast<float>(mean - half), static_cast<float>(mean + half)};
  }

 private:
  float uu_ = 0, uv_ = 0, vv_ = 0, a_ = 0, b_ = 0, c_ = 0;
};

glm::vec2 fitted(const QuadMesh& mesh, std::span<const glm::vec3> normals, std::uint32_t vertex) {
  const glm::vec3 origin = mesh.positions[vertex], n = normals[vertex];
  // Tangent frame without branches (Duff et al. 2017).
  const float sign = std::copysign(1.0f, n.z), p = -1.0f / (sign + n.z), q = n.x * n.y * p;
  const glm::vec3 e0(1.0f + sign * n.x * n.x * p, sign * q, -sign * n.x), e1(q, sign + n.y * n.y * p, -n.y);
  ShapeOperatorFit fit;
  for (const std::uint32_t quad : mesh.quads_of(vertex)) {
    const Corners corners = corners_of(mesh, normals, quad);
    std::array<glm::vec2, 4> u, d;
    for (std::size_t c = 0; c < 4; ++c) {
      const glm::vec3 r = corners.position[c] - origin;
      u[c] = {glm::dot(r, e0), glm::dot(r, e1)};
      d[c] = {glm::dot(corners.normal[c], e0), glm::dot(corners.normal[c], e1)};
    }
    fit.add(u[2] - u[0], d[2] - d[0]);
    fit.add(u[3] - u[1], d[3] - d[1]);
    fit.add(0.5f * (u[1] + u[2] - u[0] - u[3]), 0.5f * (d[1] + d[2] - d[0] - d[3]));
    fit.add(0.5f * (u[2] + u[3] - u[0] - u[1]), 0.5f * (d[2] + d[3] - d[0] - d[1]));
  }
  return fit.principal();
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
  std::vector<glm::vec2> pairs;
  if (method == CurvatureMethod::kPairs) {
    pairs.resize(mesh.quads.size());
    parallel_for(mesh.quad_count(), kCurvatureGrain, [&](std::int64_t q) {
      pairs[static_cast<std::size_t>(q)] = diagonal_extremes(mesh, normals, static_cast<std::uint32_t>(q));
    });
  }
  Curvatures result;
  result.k_min.resize(normals.size());
  result.k_max.resize(normals.size());
  parallel_chunks(mesh.vertex_count(), kCurvatureGrain, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    for (std::int64_t i = begin; i < end; ++i) {
      const auto v = static_cast<std::uint32_t>(i);
      const glm::vec2 k =
          method == CurvatureMethod::kPairs ? median_pair(mesh.quads_of(v), pairs) : fitted(mesh, normals, v);
      result.k_min[v] = k.x;
      result.k_max[v] = k.y;
    }
    progress.advance(end - begin);
  });
  if (progress.cancelled()) return cancelled_error();
  progress.end();
  return result;
}

}  // namespace dubsar
