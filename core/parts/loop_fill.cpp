#include "core/parts/loop_fill.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "core/parts/patch_refine.h"

namespace dubsar {
namespace {

/// Cost of a triangulation: bend is the largest 1 - cos(dihedral angle), 0 where it does not count.
constexpr float kImpossible = std::numeric_limits<float>::infinity();

/// Dynamic programme over the sub-polygons i..j of a polygon given as indices into the loop. Least sum of area and, for
/// every edge, length times (1 - cos dihedral) times a length that grows with the loop: one sharp corner of the rim
/// does not hide all other angles.
class OptimalTriangulation {
 public:
  OptimalTriangulation(const Loop& loop, std::vector<std::uint32_t> polygon)
      : loop_(loop),
        polygon_(std::move(polygon)),
        n_(polygon_.size()),
        best_(n_ * n_, kImpossible),
        apex_(n_ * n_, 0) {}

  /// Appends triangles in loop indices; false when every triangulation needs a forbidden edge.
  Result<bool> solve(std::vector<Triangle>& triangles, Progress& progress) {
    constexpr float kStiffness = 1.0f / 16.0f;  // of the loop's length: two fifths of its radius
    for (std::size_t i = 0; i < n_; ++i) stiffness_ += kStiffness * glm::distance(at(i), at((i + 1) % n_));
    for (std::size_t i = 0; i + 1 < n_; ++i) best_[i * n_ + i + 1] = 0.0f;
    for (std::size_t gap = 2; gap < n_; ++gap) {
      if (progress.cancelled()) return cancelled_error();
      for (std::size_t i = 0; i + gap < n_; ++i) find_apex(i, i + gap);
    }
    if (best_[n_ - 1] == kImpossible) return false;
    std::vector<std::pair<std::size_t, std::size_t>> todo{{0, n_ - 1}};
    while (!todo.empty()) {
      const auto [i, j] = todo.back();
      todo.pop_back();
      if (j < i + 2) continue;
      const std::size_t k = apex_[i * n_ + j];
      triangles.push_back({polygon_[i], polygon_[k], polygon_[j]});
      todo.emplace_back(k, j);
      todo.emplace_back(i, k);
    }
    return true;
  }

 private:
  const glm::vec3& at(std::size_t i) const { return loop_.positions[polygon_[i]]; }

  /// Normal on the far side of polygon edge or chord i, j (i < j); false when not known.
  bool far_normal(std::size_t i, std::size_t j, glm::vec3& normal) const {
    if (j > i + 1) {
      const std::size_t k = apex_[i * n_ + j];
      normal = glm::cross(at(k) - at(i), at(j) - at(i));
      const float length = glm::length(normal);
      if (length <= 0.0f) return false;
      normal /= length;
      return true;
    }
    return rim_normal(polygon_[i], polygon_[j], normal);
  }

  /// Of the loop between two of its vertices, halfway.
  bool rim_normal(std::uint32_t from, std::uint32_t to, glm::vec3& normal) const {
    const auto n = static_cast<std::uint32_t>(loop_.positions.size());
    if (loop_.rim_normals.empty()) return false;
    normal = loop_.rim_normals[(from + (to + n - from) % n / 2) % n];
    return true;
  }

  void find_apex(std::size_t i, std::size_t j) {
    const bool closing = i == 0 && j == n_ - 1;
    if (!closing && loop_.forbidden && loop_.forbidden(polygon_[i], polygon_[j])) return;
    float best = kImpossible;
    const auto bend = [&](const glm::vec3& a, const glm::vec3& b, std::size_t from, std::size_t to) {
      return stiffness_ * (1.0f - glm::dot(a, b)) * glm::distance(at(from), at(to));
    };
    std::size_t apex = i + 1;
    const glm::vec3 side = at(j) - at(i);
    for (std::size_t k = i + 1; k < j; ++k) {
      float cost = best_[i * n_ + k] + best_[k * n_ + j];
      if (cost == kImpossible) continue;
      const glm::vec3 vector = glm::cross(at(k) - at(i), side);
      const float twice_area = glm::length(vector);
      cost += 0.5f * twice_area;
      const glm::vec3 normal = twice_area > 0.0f ? vector / twice_area : glm::vec3(0.0f);
      glm::vec3 other;
      if (far_normal(i, k, other)) cost += bend(normal, other, i, k);
      if (far_normal(k, j, other)) cost += bend(normal, other, k, j);
      if (closing && rim_normal(polygon_[j], polygon_[0], other)) cost += bend(normal, other, i, j);
      if (cost < best) {
        best = cost;
        apex = k;
      }
    }
    best_[i * n_ + j] = best;
    apex_[i * n_ + j] = static_cast<std::uint32_t>(apex);
  }

  const Loop& loop_;
  std::vector<std::uint32_t> polygon_;
  float stiffness_ = 0.0f;
  std::size_t n_;
  std::vector<float> best_;
  std::vector<std::uint32_t> apex_;
};

/// A fan around one new vertex: needs no inner edge between vertices of the loop.
void add_star(const Loop& loop, const std::vector<std::uint32_t>& polygon, LoopFill& fill) {
  const auto centre = static_cast<std::uint32_t>(loop.positions.size() + fill.added.size());
  glm::vec3 middle(0.0f);
  for (const std::uint32_t v : polygon) middle += loop.positions[v];
  fill.added.push_back(middle / static_cast<float>(polygon.size()));
  for (std::size_t i = 0; i < polygon.size(); ++i)
    fill.triangles.push_back({polygon[i], polygon[(i + 1) % polygon.size()], centre});
}

/// Triangulates a polygon of any size: a long one is cut into chains along a coarse polygon, which are
/// treated alike.
Result<void> triangulate_polygon(const Loop& loop, const std::vector<std::uint32_t>& polygon,
                                 const LoopFillOptions& options, LoopFill& fill, Progress& progress) {
  const std::size_t n = polygon.size();
  if (n < 3) return {};
  const auto limit = static_cast<std::size_t>(std::max(options.exact_limit, 8));
  const auto solve = [&](const std::vector<std::uint32_t>& piece) -> Result<void> {
    DUBSAR_ASSIGN(const bool done, OptimalTriangulation(loop, piece).solve(fill.triangles, progress));
    if (!done) {
      fill.star = true;
      add_star(loop, piece, fill);
    }
    return {};
  };
  if (n <= limit) return solve(polygon);

  const auto allowed = [&](std::size_t a, std::size_t b) {
    return b == a + 1 || !loop.forbidden || !loop.forbidden(polygon[a], polygon[b]);
  };
  std::vector<std::size_t> cuts{0};
  for (std::size_t piece = 1; piece < limit; ++piece) {
    std::size_t to = std::max(cuts.back() + 1, piece * (n - 1) / limit);
    while (to < n - 1 && !allowed(cuts.back(), to)) ++to;
    if (to < n - 1) cuts.push_back(to);
  }
  // The last chain ends at the last vertex; from there to the first is an edge of the polygon already.
  while (cuts.size() > 1 && !allowed(cuts.back(), n - 1)) cuts.pop_back();
  cuts.push_back(n - 1);
  if (cuts.size() < 3) {
    fill.star = true;
    add_star(loop, polygon, fill);
    return {};
  }
  std::vector<std::uint32_t> coarse{polygon[0]};
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    const std::vector<std::uint32_t> chain(polygon.begin() + static_cast<std::ptrdiff_t>(cuts[c]),
                                           polygon.begin() + static_cast<std::ptrdiff_t>(cuts[c + 1]) + 1);
    DUBSAR_TRY(triangulate_polygon(loop, chain, options, fill, progress));
    coarse.push_back(polygon[cuts[c + 1]]);
  }
  return solve(coarse);
}

}  // namespace

Result<LoopFill> fill_loop(const Loop& loop, const LoopFillOptions& options, Progress& progress) {
  const std::size_t n = loop.positions.size();
  DUBSAR_CHECK(n >= 3 && n < 0x7fffffff);
  std::vector<std::uint32_t> polygon(n);
  std::iota(polygon.begin(), polygon.end(), 0u);
  LoopFill fill;
  DUBSAR_TRY(triangulate_polygon(loop, polygon, options, fill, progress));
  if (options.refine) {
    Patch patch(loop, std::move(fill.triangles), std::move(fill.added));
    DUBSAR_TRY(patch.refine(options.growth, progress));
    DUBSAR_TRY(patch.relax(options.fairing_steps, progress));
    DUBSAR_TRY(patch.continue_surface(options.fairing_steps, progress));
    std::move(patch).release(fill.triangles, fill.added);
  }
  const auto at = [&](std::uint32_t v) { return v < n ? loop.positions[v] : fill.added[v - n]; };
  for (const Triangle& t : fill.triangles)
    fill.area += 0.5 * static_cast<double>(glm::length(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]))));
  return fill;
}

}  // namespace dubsar
