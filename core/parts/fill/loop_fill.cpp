#include "core/parts/fill/loop_fill.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "core/parts/fill/patch_refine.h"

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
      : loop_(loop), polygon_(std::move(polygon)), n_(polygon_.size()), apex_(n_ * n_, 0), beyond_(n_ * n_) {
    for (const std::uint32_t step : polygon_) points_.push_back(loop.positions[loop.vertex(step)]);
  }

  /// Appends triangles of steps of the walk; false when every triangulation needs a forbidden edge.
  Result<bool> solve(std::vector<Triangle>& triangles, Progress& progress) {
    constexpr float kStiffness = 1.0f / 16.0f;  // of the loop's length: two fifths of its radius
    for (std::size_t i = 0; i < n_; ++i) stiffness_ += kStiffness * glm::distance(at(i), at((i + 1) % n_));
    for (std::size_t i = 0; i + 1 < n_; ++i) {
      Beyond edge{.cost = 0.0f, .length = glm::distance(at(i), at(i + 1))};
      edge.known = rim_normal(polygon_[i], polygon_[i + 1], edge.normal);
      keep(i, i + 1, edge);
    }
    for (std::size_t gap = 2; gap < n_; ++gap) {
      if (progress.cancelled()) return cancelled_error();
      for (std::size_t i = 0; i + gap < n_; ++i) find_apex(i, i + gap);
    }
    if (beyond_[n_ - 1].cost == kImpossible) return false;
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
  const glm::vec3& at(std::size_t i) const { return points_[i]; }

  /// What lies beyond an edge or chord i, j of the polygon (i < j): the best triangulation of what it cuts off.
  struct Beyond {
    float cost = kImpossible, length = 0.0f;
    glm::vec3 normal{0.0f};  ///< of the triangle at the chord, or of the rim at an edge
    bool known = false;      ///< the normal
  };

  /// Under both orders, so that the chords of one vertex lie side by side.
  void keep(std::size_t i, std::size_t j, const Beyond& beyond) { beyond_[i * n_ + j] = beyond_[j * n_ + i] = beyond; }

  /// Of the loop between two of its vertices, halfway.
  bool rim_normal(std::uint32_t from, std::uint32_t to, glm::vec3& normal) const {
    const auto n = static_cast<std::uint32_t>(loop_.steps());
    if (loop_.rim_normals.empty()) return false;
    normal = loop_.rim_normals[(from + (to + n - from) % n / 2) % n];
    return normal != glm::vec3(0.0f);
  }

  void find_apex(std::size_t i, std::size_t j) {
    const bool closing = i == 0 && j == n_ - 1;
    if (!closing && !loop_.may_join(loop_.vertex(polygon_[i]), loop_.vertex(polygon_[j]))) return;
    const auto bend = [&](const glm::vec3& a, const glm::vec3& b, float length) {
      return stiffness_ * (1.0f - glm::dot(a, b)) * length;
    };
    Beyond best;
    std::size_t apex = i + 1;
    const glm::vec3 side = at(j) - at(i);
    best.length = glm::distance(at(i), at(j));
    glm::vec3 behind;
    const bool rim_behind = closing && rim_normal(polygon_[j], polygon_[0], behind);
    const Beyond *const from_i = beyond_.data() + i * n_, *const from_j = beyond_.data() + j * n_;
    for (std::size_t k = i + 1; k < j; ++k) {
      const Beyond &left = from_i[k], &right = from_j[k];
      float cost = left.cost + right.cost;
      if (cost >= best.cost) continue;  // angles and areas only add to it
      const glm::vec3 vector = glm::cross(at(k) - at(i), side);
      const float twice_area = glm::length(vector);
      cost += 0.5f * twice_area;
      const glm::vec3 normal = twice_area > 0.0f ? vector / twice_area : glm::vec3(0.0f);
      if (left.known) cost += bend(normal, left.normal, left.length);
      if (right.known) cost += bend(normal, right.normal, right.length);
      if (rim_behind) cost += bend(normal, behind, best.length);
      if (cost < best.cost) {
        best.cost = cost;
        best.normal = normal;
        best.known = twice_area > 0.0f;
        apex = k;
      }
    }
    keep(i, j, best);
    apex_[i * n_ + j] = static_cast<std::uint32_t>(apex);
  }

  const Loop& loop_;
  std::vector<std::uint32_t> polygon_;  ///< steps of its walk
  std::vector<glm::vec3> points_;
  float stiffness_ = 0.0f;
  std::size_t n_;
  std::vector<std::uint32_t> apex_;
  std::vector<Beyond> beyond_;
};

/// A fan around one new vertex: needs no inner edge between vertices of the loop.
void add_star(const Loop& loop, const std::vector<std::uint32_t>& polygon, LoopFill& fill) {
  const auto centre = static_cast<std::uint32_t>(loop.steps() + fill.added.size());
  glm::vec3 middle(0.0f);
  for (const std::uint32_t step : polygon) middle += loop.positions[loop.vertex(step)];
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
    return b == a + 1 || loop.may_join(loop.vertex(polygon[a]), loop.vertex(polygon[b]));
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

/// Triangles of vertices instead of steps of the walk. Both sides of a bridge become one edge.
void close_bridges(const Loop& loop, LoopFill& fill) {
  if (loop.walk.empty()) return;
  const auto vertices = static_cast<std::uint32_t>(loop.positions.size()),
             steps = static_cast<std::uint32_t>(loop.walk.size());
  std::unordered_map<std::uint64_t, int> uses;
  for (Triangle& t : fill.triangles) {
    for (std::uint32_t& v : t) v = v < steps ? loop.walk[v] : v - steps + vertices;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a == b || ++uses[std::uint64_t{std::min(a, b)} << 32 | std::max(a, b)] > 2) fill.doubled = true;
    }
  }
}

}  // namespace

Result<LoopFill> fill_loop(const Loop& loop, const LoopFillOptions& options, Progress& progress) {
  const std::size_t n = loop.positions.size();
  DUBSAR_CHECK(n >= 3 && loop.steps() < 0x7fffffff);
  std::vector<std::uint32_t> polygon(loop.steps());
  std::iota(polygon.begin(), polygon.end(), 0u);
  LoopFill fill;
  DUBSAR_TRY(triangulate_polygon(loop, polygon, options, fill, progress));
  close_bridges(loop, fill);
  if (fill.doubled) return fill;
  if (options.refine) {
    Patch patch(loop, std::move(fill.triangles), std::move(fill.added));
    DUBSAR_TRY(patch.refine(options.growth, progress));
    DUBSAR_TRY(patch.relax(options.fairing_steps, progress));
    for (int bend = 0; bend < options.bends; ++bend) {
      if (bend > 0) DUBSAR_TRY(patch.refine(options.growth, progress));
      DUBSAR_TRY(patch.continue_surface(options.fairing_steps, progress));
    }
    std::move(patch).release(fill.triangles, fill.added);
  }
  const auto at = [&](std::uint32_t v) { return v < n ? loop.positions[v] : fill.added[v - n]; };
  for (const Triangle& t : fill.triangles)
    fill.area += 0.5 * static_cast<double>(glm::length(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]))));
  return fill;
}

}  // namespace dubsar
