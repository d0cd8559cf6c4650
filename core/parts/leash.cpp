#include "core/parts/leash.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "core/parts/triangle_grid.h"

namespace dubsar {

std::vector<float> leashes(std::span<const glm::vec3> points, std::span<const glm::vec3> places) {
  std::vector<float> leash(points.size(), 1.0f);
  if (places.empty()) return leash;
  constexpr float kTied = 1.5f, kSlack = 2.5f;  // nothing moves; all moves are free again
  constexpr float kFree = kTied + kSlack;
  const auto bin = [](const glm::vec3& p) {
    const glm::ivec3 b(glm::floor(p / kFree));
    return std::array<int, 3>{b.x, b.y, b.z};
  };
  std::map<std::array<int, 3>, std::vector<glm::vec3>> bins;
  for (const glm::vec3& place : places) bins[bin(place)].push_back(place);
  std::vector<TriangleBox> boxes;
  for (const glm::vec3& place : places) boxes.push_back(TriangleBox{place, place}.grown(kFree));
  const BrickSet near(boxes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!near.meets({points[i], points[i]})) continue;
    const std::array<int, 3> here = bin(points[i]);
    for (int k = 0; k < 27; ++k) {
      const auto found = bins.find({here[0] + k % 3 - 1, here[1] + k / 3 % 3 - 1, here[2] + k / 9 - 1});
      if (found == bins.end()) continue;
      for (const glm::vec3& place : found->second)
        leash[i] = std::min(leash[i], std::max(0.0f, (glm::distance(place, points[i]) - kTied) / kSlack));
    }
  }
  return leash;
}

}  // namespace dubsar
