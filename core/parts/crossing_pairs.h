#pragma once
// Pairs of triangles that cross, and which of them still do when some triangles have changed.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/system/parallel_gather.h"
#include "core/mesh/intersections.h"
#include "core/parts/triangle_grid.h"

namespace dubsar {

using CrossingPairs = std::vector<std::array<std::uint32_t, 2>>;

/// Triangles whose cubes of 8 steps are among some.
inline std::vector<std::uint32_t> triangles_in(const BrickSet& bricks, std::span<const glm::vec3> positions,
                                               std::span<const Triangle> triangles) {
  return parallel_gather<std::uint32_t>(static_cast<std::int64_t>(triangles.size()), 1 << 16,
                                        [&](std::int64_t begin, std::int64_t end, std::vector<std::uint32_t>& some) {
                                          for (auto t = static_cast<std::uint32_t>(begin);
                                               t < static_cast<std::uint64_t>(end); ++t)
                                            if (bricks.meets(box_of(positions, triangles[t]))) some.push_back(t);
                                        });
}

/// Pairs, rising, of which one is `wanted` (one a triangle) and that matter(a, b).
template <class Matter>
CrossingPairs crossing_pairs(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                             std::span<const std::uint8_t> wanted, const Matter& matter) {
  CrossingPairs pairs = self_intersections(positions, triangles, wanted);
  std::erase_if(pairs, [&](const auto& pair) { return !matter(pair[0], pair[1]); });
  return pairs;
}

/// The same where they were `before` the triangles that are marked in `changed` did: only those are looked at.
template <class Matter>
CrossingPairs crossing_pairs_after(CrossingPairs before, std::span<const glm::vec3> positions,
                                   std::span<const Triangle> triangles, std::span<const std::uint8_t> changed,
                                   const Matter& matter) {
  std::vector<TriangleBox> boxes;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (changed[t] != 0) boxes.push_back(box_of(positions, triangles[t]));
  const std::vector<std::uint32_t> some = triangles_in(BrickSet(boxes), positions, triangles);
  std::vector<Triangle> near;
  std::vector<std::uint8_t> wanted;
  for (const std::uint32_t t : some) {
    near.push_back(triangles[t]);
    wanted.push_back(changed[t]);
  }
  std::erase_if(before, [&](const auto& pair) { return changed[pair[0]] != 0 || changed[pair[1]] != 0; });
  for (const auto& [a, b] : crossing_pairs(positions, near, wanted,
                                           [&](std::uint32_t i, std::uint32_t j) { return matter(some[i], some[j]); }))
    before.push_back({some[a], some[b]});
  std::sort(before.begin(), before.end());
  return before;
}

}  // namespace dubsar
