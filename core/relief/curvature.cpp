#include "core/relief/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>

#include "core/base/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kCurvatureGrain = 8192, kBlockVertices = 32768;

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

/// Four numbers in a vector unit; of a vec3 the fourth is 0.
typedef float Float4 __attribute__((vector_size(16)));
Float4 wide(const glm::vec3& v) { return Float4{v.x, v.y, v.z, 0.0f}; }

/// What an x-quad adds to the normal equations of min sum |S u - d|^2 around each of its vertices, before it is known
/// in which plane: sums over its differences u of positions and d of normals of u.x u, u.y u, u.z u, d.x u, d.y u, d.z
/// u.
struct Moments {
  Float4 of[6] = {};
};

Moments moments_of(const Corners& corners) {
  const auto &p = corners.position, &n = corners.normal;
  const std::array<glm::vec3, 4> u{p[2] - p[0], p[3] - p[1], 0.5f * (p[1] + p[2] - p[0] - p[3]),
                                   0.5f * (p[2] + p[3] - p[0] - p[1])},
      d{n[2] - n[0], n[3] - n[1], 0.5f * (n[1] + n[2] - n[0] - n[3]), 0.5f * (n[2] + n[3] - n[0] - n[1])};
  Moments m{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Float4 a = wide(u[k]);
    m.of[0] += u[k].x * a;
    m.of[1] += u[k].y * a;
    m.of[2] += u[k].z * a;
    m.of[3] += d[k].x * a;
    m.of[4] += d[k].y * a;
    m.of[5] += d[k].z * a;
  }
  return m;
}

/// Eigenvalues of S = [a b; b c], smaller first, in the tangent plane of a normal.
glm::vec2 principal(const Moments& m, const glm::vec3& n) {
  // Tangent frame without branches (Duff et al. 2017).
  const float sign = std::copysign(1.0f, n.z), p = -1.0f / (sign + n.z), q = n.x * n.y * p;
  const glm::vec3 e0(1.0f + sign * n.x * n.x * p, sign * q, -sign * n.x), e1(q, sign + n.y * n.y * p, -n.y);
  const auto sum = [&m](std::size_t first, const glm::vec3& e) {
    const Float4 v = m.of[first] * e.x + m.of[first + 1] * e.y + m.of[first + 2] * e.z;
    return glm::vec3(v[0], v[1], v[2]);
  };
  const auto squared = [&sum](const glm::vec3& e) { return sum(0, e); };
  const auto turned = [&sum](const glm::vec3& e) { return sum(3, e); };
  const glm::vec3 u1 = squared(e1), d0 = turned(e0), d1 = turned(e1);
  const double uu0 = static_cast<double>(glm::dot(e0, squared(e0))), vv0 = static_cast<double>(glm::dot(e1, u1));
  // The small ridge keeps collinear differences solvable (S is then 0 across them); relative error 1e-5.
  const double ridge = 1e-5 * (uu0 + vv0);
  if (!(ridge > 0.0)) return glm::vec2(0.0f);
  const double uu = uu0 + ridge, vv = vv0 + ridge, uv = static_cast<double>(glm::dot(e0, u1));
  const double x = static_cast<double>(glm::dot(e0, d0)), z = static_cast<double>(glm::dot(e1, d1));
  const double y = static_cast<double>(glm::dot(e0, d1)) + static_cast<double>(glm::dot(e1, d0));
  const double b = (y - uv * (x / uu + z / vv)) / ((uu + vv) * (1.0 - uv * uv / (uu * vv)));
  const double a = (x - b * uv) / uu, c = (z - b * uv) / vv;
  const double mean = 0.5 * (a + c), half = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
  return {static_cast<float>(mean - half), static_cast<float>(mean + half)};
}

/// Moments of the x-quads around a block of vertices: their numbers lie close together, but for a few.
class BlockMoments {
 public:
  BlockMoments(const QuadMesh& mesh, std::span<const glm::vec3> normals, std::int64_t begin, std::int64_t end)
      : mesh_(mesh), normals_(normals) {
    const auto around = std::span(mesh.incident)
                            .subspan(mesh.first_incident[static_cast<std::size_t>(begin)],
                                     mesh.first_incident[static_cast<std::size_t>(end)] -
                                         mesh.first_incident[static_cast<std::size_t>(begin)]);
    if (around.empty()) return;
    first_ = *std::min_element(around.begin(), around.end());
    const auto most = first_ + static_cast<std::uint64_t>(3 * (end - begin));
    std::uint32_t last = first_;
    for (const std::uint32_t quad : around)
      if (quad > last && quad < most) last = quad;
    moments_.resize(last - first_ + 1);
    for (std::size_t i = 0; i < moments_.size(); ++i) moments_[i] = of(first_ + static_cast<std::uint32_t>(i));
  }
  glm::vec2 fitted(std::uint32_t vertex) const {
    Moments sum{};
    for (const std::uint32_t quad : mesh_.quads_of(vertex)) {
      const Moments other = quad - first_ < moments_.size() ? Moments{} : of(quad);
      const Moments& m = quad - first_ < moments_.size() ? moments_[quad - first_] : other;
      for (std::size_t i = 0; i < 6; ++i) sum.of[i] += m.of[i];
    }
    return principal(sum, normals_[vertex]);
  }

 private:
  Moments of(std::uint32_t quad) const { return moments_of(corners_of(mesh_, normals_, quad)); }
  const QuadMesh& mesh_;
  std::span<const glm::vec3> normals_;
  std::uint32_t first_ = 0;
  std::vector<Moments> moments_;
};

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
  parallel_chunks(mesh.vertex_count(), kBlockVertices, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    std::optional<BlockMoments> moments;
    if (method == CurvatureMethod::kFit) moments.emplace(mesh, normals, begin, end);
    for (std::int64_t i = begin; i < end; ++i) {
      const auto v = static_cast<std::uint32_t>(i);
      const glm::vec2 k = moments ? moments->fitted(v) : median_pair(mesh.quads_of(v), pairs);
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
