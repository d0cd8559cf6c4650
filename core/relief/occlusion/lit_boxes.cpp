#include "core/relief/occlusion/lit_boxes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr std::int64_t kBoxGrain = 1 << 18;

}  // namespace

std::vector<LitBox> lit_boxes(std::span<const glm::vec3> positions, const std::vector<std::uint32_t>& ids, float margin,
                              double most_cells) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const std::uint32_t v : ids) {
    low = glm::min(low, positions[v]);
    high = glm::max(high, positions[v]);
  }
  low = glm::floor(low);
  const glm::vec3 size = glm::floor(high) + 1.0f - low;
  constexpr double kTooLarge = 1e12;  // cells: SurfaceBricks refuses it
  if (double{size.x} * size.y * size.z > kTooLarge) return {{low, low + size}};
  glm::ivec3 parts(1);
  glm::vec3 edge = size;
  for (const glm::vec3 least(margin);;) {
    const glm::dvec3 grown = glm::dvec3(edge) + 2.0 * margin;
    if (grown.x * grown.y * grown.z <= most_cells || glm::all(glm::lessThan(edge, least))) break;
    const int axis = edge.x >= edge.y && edge.x >= edge.z ? 0 : edge.y >= edge.z ? 1 : 2;
    ++parts[axis];
    edge[axis] = std::ceil(size[axis] / static_cast<float>(parts[axis]));
  }
  std::vector<LitBox> out;
  for (int z = 0; z < parts.z; ++z)
    for (int y = 0; y < parts.y; ++y)
      for (int x = 0; x < parts.x; ++x) {
        const glm::vec3 first = low + glm::vec3(x, y, z) * edge;
        out.push_back({first, first + edge});
      }
  return out;
}

std::vector<Triangle> triangles_near(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                                     const LitBox& box, float margin) {
  const glm::vec3 low = box.low - margin, high = box.high + margin;
  return parallel_gather<Triangle>(static_cast<std::int64_t>(triangles.size()), kBoxGrain,
                                   [&](std::int64_t begin, std::int64_t end, std::vector<Triangle>& found) {
                                     for (const Triangle& t : triangles.subspan(
                                              static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin))) {
                                       const glm::vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
                                       if (glm::all(glm::lessThanEqual(glm::min(glm::min(a, b), c), high)) &&
                                           glm::all(glm::greaterThanEqual(glm::max(glm::max(a, b), c), low)))
                                         found.push_back(t);
                                     }
                                   });
}

std::vector<std::uint32_t> vertices_in(std::span<const glm::vec3> positions, const std::vector<std::uint32_t>& ids,
                                       const LitBox& box) {
  using Ids = std::vector<std::uint32_t>;
  return parallel_gather<std::uint32_t>(
      static_cast<std::int64_t>(ids.size()), kBoxGrain, [&](std::int64_t begin, std::int64_t end, Ids& found) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
          if (box.holds(positions[ids[i]])) found.push_back(ids[i]);
      });
}

}  // namespace dubsar
