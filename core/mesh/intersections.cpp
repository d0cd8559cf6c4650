#include "core/mesh/intersections.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "core/base/numbers/morton_code.h"
#include "core/base/result.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

using Corners = std::array<glm::dvec3, 3>;

struct Box {
  glm::vec3 low{1e30f}, high{-1e30f};
  void add(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool meets(const Box& other) const {
    for (int a = 0; a < 3; ++a)
      if (low[a] > other.high[a] || high[a] < other.low[a]) return false;
    return true;
  }
};

/// Six times the signed volume of a tetrahedron.
double volume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a);
}

/// On which side of the plane of a triangle points are.
class Sides {
 public:
  Sides(const Corners& triangle, const Corners& points) {
    const glm::dvec3 across = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    for (std::size_t i = 0; i < 3; ++i) side_[i] = glm::dot(across, points[i] - triangle[0]);
  }
  bool differ(std::size_t i, std::size_t j) const {
    return (side_[i] > 0.0 && side_[j] < 0.0) || (side_[i] < 0.0 && side_[j] > 0.0);
  }
  bool any_differ() const { return differ(0, 1) || differ(1, 2) || differ(2, 0); }

 private:
  std::array<double, 3> side_;
};

/// A segment whose ends are on both sides of the plane of a triangle passes through its inside.
bool passes(const glm::dvec3& from, const glm::dvec3& to, const Corners& t) {
  const double a = volume(from, to, t[0], t[1]), b = volume(from, to, t[1], t[2]), c = volume(from, to, t[2], t[0]);
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

/// Boxes of triangles in the order of a curve that fills space, and of eight of them together, and of eight of those.
class Tree {
 public:
  Tree(std::span<const glm::vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles)
      : positions_(positions), triangles_(triangles), box_(triangles.size()), order_(triangles.size()) {
    parallel_for(count(), kTreeGrain, [&](std::int64_t i) {
      for (const std::uint32_t v : triangles_[at(i)]) box_[at(i)].add(positions_[v]);
    });
    sort_by_place();
    levels_.emplace_back(triangles.size());
    parallel_for(count(), kTreeGrain, [&](std::int64_t i) { levels_[0][at(i)] = box_[order_[at(i)]]; });
    while (levels_.back().size() > kFan) {
      const std::vector<Box>& below = levels_.back();
      std::vector<Box> level((below.size() + kFan - 1) / kFan);
      for (std::size_t i = 0; i < below.size(); ++i) level[i / kFan].add(below[i]);
      levels_.push_back(std::move(level));
    }
  }

  /// Partners of a triangle for which keep(partner) holds, rising.
  template <class Keep>
  void partners(std::uint32_t triangle, std::vector<std::uint32_t>& found, const Keep& keep) const {
    found.clear();
    const std::size_t top = levels_.size() - 1;
    look(triangle, top, 0, levels_[top].size(), found, keep);
    std::sort(found.begin(), found.end());
  }

 private:
  static constexpr std::size_t kFan = 8;
  static constexpr std::int64_t kTreeGrain = 1 << 14;

  std::int64_t count() const { return static_cast<std::int64_t>(triangles_.size()); }
  static std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

  void sort_by_place() {
    Box all;
    for (const Box& b : box_) all.add(b);
    const glm::vec3 size = glm::max(all.high - all.low, glm::vec3(1e-30f));
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(box_.size());
    parallel_for(count(), kTreeGrain, [&](std::int64_t i) {
      const glm::vec3 middle = 0.5f * (box_[at(i)].low + box_[at(i)].high);
      const glm::vec3 share = glm::clamp((middle - all.low) / size, 0.0f, 1.0f) * 2097151.0f;
      keys[at(i)] = {morton_code(share), static_cast<std::uint32_t>(i)};
    });
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i) order_[i] = keys[i].second;
  }

  /// Boxes [begin, end) of a level.
  template <class Keep>
  void look(std::uint32_t triangle, std::size_t level, std::size_t begin, std::size_t end,
            std::vector<std::uint32_t>& found, const Keep& keep) const {
    const Box& own = box_[triangle];
    for (std::size_t i = begin; i < end; ++i) {
      if (!levels_[level][i].meets(own)) continue;
      if (level > 0) {
        look(triangle, level - 1, i * kFan, std::min((i + 1) * kFan, levels_[level - 1].size()), found, keep);
      } else if (const std::uint32_t other = order_[i];
                 other != triangle && keep(other) &&
                 triangles_cross(positions_, triangles_[std::min(triangle, other)],
                                 triangles_[std::max(triangle, other)])) {
        found.push_back(other);
      }
    }
  }

  std::span<const glm::vec3> positions_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::vector<Box> box_;                  ///< of each triangle
  std::vector<std::uint32_t> order_;      ///< triangles along the curve
  std::vector<std::vector<Box>> levels_;  ///< the lowest: boxes of the triangles in that order
};

}  // namespace

bool triangles_cross(std::span<const glm::vec3> positions, const std::array<std::uint32_t, 3>& a,
                     const std::array<std::uint32_t, 3>& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [&](std::uint32_t v) { return positions[v][axis]; };
    if (std::max({along(a[0]), along(a[1]), along(a[2])}) < std::min({along(b[0]), along(b[1]), along(b[2])}) ||
        std::max({along(b[0]), along(b[1]), along(b[2])}) < std::min({along(a[0]), along(a[1]), along(a[2])}))
      return false;
  }
  int shared = 0;
  for (const std::uint32_t v : a) shared += std::count(b.begin(), b.end(), v) != 0;
  if (shared >= 2) return false;
  const auto corners = [&](const std::array<std::uint32_t, 3>& t) {
    return Corners{glm::dvec3(positions[t[0]]), glm::dvec3(positions[t[1]]), glm::dvec3(positions[t[2]])};
  };
  const Corners ca = corners(a), cb = corners(b);
  // Both go through the plane of the other, or none goes through the other.
  const Sides of_b(ca, cb);
  if (!of_b.any_differ()) return false;
  const Sides of_a(cb, ca);
  if (!of_a.any_differ()) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if ((of_a.differ(i, next) && passes(ca[i], ca[next], cb)) || (of_b.differ(i, next) && passes(cb[i], cb[next], ca)))
      return true;
  }
  return false;
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(std::span<const glm::vec3> positions,
                                                             std::span<const std::array<std::uint32_t, 3>> triangles,
                                                             std::span<const std::uint8_t> wanted) {
  DUBSAR_CHECK(wanted.empty() || wanted.size() == triangles.size());
  if (triangles.empty()) return {};
  const Tree tree(positions, triangles);
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  const auto is_wanted = [&](std::uint32_t t) { return wanted.empty() || wanted[t] != 0; };
  Pairs pairs = parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), 4096, Pairs{},
      [&](std::int64_t begin, std::int64_t end) {
        Pairs part;
        std::vector<std::uint32_t> found;
        for (auto t = static_cast<std::uint32_t>(begin); t < static_cast<std::uint32_t>(end); ++t) {
          if (!is_wanted(t)) continue;
          tree.partners(t, found, [&](std::uint32_t other) { return other > t || !is_wanted(other); });
          for (const std::uint32_t other : found) part.push_back({std::min(t, other), std::max(t, other)});
        }
        return part;
      },
      [](Pairs a, const Pairs& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace dubsar
