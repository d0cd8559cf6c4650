#pragma once
// Which triangles are near? Boxes of triangles by cubes of the grid.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct TriangleBox {
  glm::vec3 low, high;
  TriangleBox grown(float by) const { return {low - by, high + by}; }
};

inline TriangleBox box_of(std::span<const glm::vec3> positions, const Triangle& t) {
  const glm::vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
  return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

/// Calls body(key) for each cube of `edge` grid steps that a box meets.
template <class Body>
void for_each_cube(const TriangleBox& box, float edge, const Body& body) {
  const auto cell = [edge](float x) { return static_cast<std::int64_t>(std::floor(x / edge)) + (1 << 20); };
  for (std::int64_t z = cell(box.low.z); z <= cell(box.high.z); ++z)
    for (std::int64_t y = cell(box.low.y); y <= cell(box.high.y); ++y)
      for (std::int64_t x = cell(box.low.x); x <= cell(box.high.x); ++x) body(z << 42 | y << 21 | x);
}

/// Cubes of 8 steps.
class BrickSet {
 public:
  void add(const TriangleBox& box) {
    for_each_cube(box, 8.0f, [&](std::int64_t key) { keys_.insert(key); });
  }
  bool meets(const TriangleBox& box) const {
    bool found = false;
    for_each_cube(box, 8.0f, [&](std::int64_t key) { found = found || keys_.count(key) != 0; });
    return found;
  }

 private:
  std::unordered_set<std::int64_t> keys_;
};

/// Triangles by cubes of 2 steps. One that moved is added once more: it is found where it was, too.
class TriangleGrid {
 public:
  void add(std::uint32_t triangle, const TriangleBox& box) {
    for_each_cube(box, 2.0f, [&](std::int64_t key) { cubes_[key].push_back(triangle); });
  }
  /// Those whose cubes the box meets, each once, rising.
  void near(const TriangleBox& box, std::vector<std::uint32_t>& found) const {
    found.clear();
    for_each_cube(box, 2.0f, [&](std::int64_t key) {
      if (const auto cube = cubes_.find(key); cube != cubes_.end())
        found.insert(found.end(), cube->second.begin(), cube->second.end());
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }

 private:
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cubes_;
};

}  // namespace dubsar
