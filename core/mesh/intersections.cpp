#include "core/mesh/intersections.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/base/parallel.h"

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

/// The segment passes through the inside of the triangle, both ends off its plane.
bool crosses(const glm::dvec3& from, const glm::dvec3& to, const Corners& t) {
  const double above = volume(t[0], t[1], t[2], from), below = volume(t[0], t[1], t[2], to);
  if (!((above > 0.0 && below < 0.0) || (above < 0.0 && below > 0.0))) return false;
  const double a = volume(from, to, t[0], t[1]), b = volume(from, to, t[1], t[2]), c = volume(from, to, t[2], t[0]);
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

class Tree {
 public:
  Tree(std::span<const glm::vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles)
      : positions_(positions), triangles_(triangles), order_(triangles.size()), box_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (const std::uint32_t v : triangles[i]) box_[i].add(positions[v]);
    if (!order_.empty()) build(0, order_.size());
  }

  /// Partners of a triangle with higher numbers, rising.
  void partners(std::uint32_t triangle, std::vector<std::uint32_t>& found) const {
    found.clear();
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
      const Node& node = nodes_[stack.back()];
      stack.pop_back();
      if (!node.box.meets(box_[triangle])) continue;
      if (node.count == 0) {
        stack.push_back(node.first);
        stack.push_back(node.second);
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (order_[i] > triangle && box_[order_[i]].meets(box_[triangle]) && intersect(triangle, order_[i]))
          found.push_back(order_[i]);
    }
    std::sort(found.begin(), found.end());
  }

 private:
  static constexpr std::size_t kLeaf = 8;
  struct Node {
    Box box;
    std::uint32_t first = 0, second = 0;  ///< children, or where the leaf begins
    std::uint32_t count = 0;              ///< of the leaf; 0: a branch
  };

  std::uint32_t build(std::size_t begin, std::size_t end) {
    const auto id = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box box, middles;
    for (std::size_t i = begin; i < end; ++i) {
      const Box& b = box_[order_[i]];
      box.add(b);
      middles.add(0.5f * (b.low + b.high));
    }
    nodes_[id].box = box;
    if (end - begin <= kLeaf) {
      nodes_[id].first = static_cast<std::uint32_t>(begin);
      nodes_[id].count = static_cast<std::uint32_t>(end - begin);
      return id;
    }
    const glm::vec3 size = middles.high - middles.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = (begin + end) / 2;
    std::nth_element(
        order_.begin() + static_cast<std::ptrdiff_t>(begin), order_.begin() + static_cast<std::ptrdiff_t>(middle),
        order_.begin() + static_cast<std::ptrdiff_t>(end), [&](std::uint32_t a, std::uint32_t b) {
          const float pa = box_[a].low[axis] + box_[a].high[axis], pb = box_[b].low[axis] + box_[b].high[axis];
          return pa != pb ? pa < pb : a < b;
        });
    const std::uint32_t first = build(begin, middle), second = build(middle, end);
    nodes_[id].first = first;
    nodes_[id].second = second;
    return id;
  }

  bool intersect(std::uint32_t a, std::uint32_t b) const {
    return triangles_cross(positions_, triangles_[a], triangles_[b]);
  }

  std::span<const glm::vec3> positions_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> box_;
  std::vector<Node> nodes_;
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
  for (std::size_t i = 0; i < 3; ++i)
    if (crosses(ca[i], ca[(i + 1) % 3], cb) || crosses(cb[i], cb[(i + 1) % 3], ca)) return true;
  return false;
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(std::span<const glm::vec3> positions,
                                                             std::span<const std::array<std::uint32_t, 3>> triangles) {
  const Tree tree(positions, triangles);
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  return parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), 4096, Pairs{},
      [&](std::int64_t begin, std::int64_t end) {
        Pairs pairs;
        std::vector<std::uint32_t> found;
        for (auto t = static_cast<std::uint32_t>(begin); t < static_cast<std::uint32_t>(end); ++t) {
          tree.partners(t, found);
          for (const std::uint32_t other : found) pairs.push_back({t, other});
        }
        return pairs;
      },
      [](Pairs a, const Pairs& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
}

}  // namespace dubsar
