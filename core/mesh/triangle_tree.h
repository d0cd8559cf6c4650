#pragma once
// Which triangles of a mesh are near one? A hierarchy of bounding boxes.

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/numbers/morton_code.h"
#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Boxes of triangles in the order of a curve that fills space, and of eight of them together, and of eight of those.
template <class Vec>
class TriangleTree {
  using Value = typename Vec::value_type;

 public:
  TriangleTree(std::span<const Vec> positions, std::span<const Triangle> triangles)
      : box_(triangles.size()), order_(triangles.size()) {
    parallel_for(count(), kTreeGrain, [&](std::int64_t i) {
      for (const std::uint32_t v : triangles[at(i)]) box_[at(i)].add(positions[v]);
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

  /// Triangles whose boxes meet that of one, but for itself, for which keep(partner) holds, rising.
  template <class Keep>
  void partners(std::uint32_t triangle, std::vector<std::uint32_t>& found, const Keep& keep) const {
    found.clear();
    const std::size_t top = levels_.size() - 1;
    look(triangle, top, 0, levels_[top].size(), found, keep);
    std::sort(found.begin(), found.end());
  }

 private:
  struct Box {
    Vec low{std::numeric_limits<Value>::max()}, high{std::numeric_limits<Value>::lowest()};
    void add(const Vec& p) {
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

  static constexpr std::size_t kFan = 8;
  static constexpr std::int64_t kTreeGrain = 1 << 14;

  std::int64_t count() const { return static_cast<std::int64_t>(box_.size()); }
  static std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

  void sort_by_place() {
    Box all;
    for (const Box& b : box_) all.add(b);
    const glm::vec3 low(all.low), size = glm::max(glm::vec3(all.high) - low, glm::vec3(1e-30f));
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(box_.size());
    parallel_for(count(), kTreeGrain, [&](std::int64_t i) {
      const glm::vec3 middle = 0.5f * (glm::vec3(box_[at(i)].low) + glm::vec3(box_[at(i)].high));
      const glm::vec3 share = glm::clamp((middle - low) / size, 0.0f, 1.0f) * 2097151.0f;
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
      } else if (const std::uint32_t other = order_[i]; other != triangle && keep(other)) {
        found.push_back(other);
      }
    }
  }

  std::vector<Box> box_;                  ///< of each triangle
  std::vector<std::uint32_t> order_;      ///< triangles along the curve
  std::vector<std::vector<Box>> levels_;  ///< the lowest: boxes of the triangles in that order
};

using TrianglePairs = std::vector<std::array<std::uint32_t, 2>>;

/// Pairs of triangles, the lower first, whose boxes meet and for which cross(lower, higher) holds. `wanted`: one a
/// triangle, or empty for all; only pairs of which one at least is not 0. Rising, whatever the number of threads.
template <class Vec, class Cross>
TrianglePairs pairs_that_cross(std::span<const Vec> positions, std::span<const Triangle> triangles,
                               std::span<const std::uint8_t> wanted, const Cross& cross) {
  DUBSAR_CHECK(wanted.empty() || wanted.size() == triangles.size());
  if (triangles.empty()) return {};
  const TriangleTree<Vec> tree(positions, triangles);
  const auto is_wanted = [&](std::uint32_t t) { return wanted.empty() || wanted[t] != 0; };
  TrianglePairs pairs = parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), 4096, TrianglePairs{},
      [&](std::int64_t begin, std::int64_t end) {
        TrianglePairs part;
        std::vector<std::uint32_t> found;
        for (auto t = static_cast<std::uint32_t>(begin); t < static_cast<std::uint32_t>(end); ++t) {
          if (!is_wanted(t)) continue;
          tree.partners(t, found, [&](std::uint32_t other) {
            return (other > t || !is_wanted(other)) && cross(std::min(t, other), std::max(t, other));
          });
          for (const std::uint32_t other : found) part.push_back({std::min(t, other), std::max(t, other)});
        }
        return part;
      },
      [](TrianglePairs a, const TrianglePairs& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace dubsar
