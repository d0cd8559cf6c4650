#pragma once
// Which triangles are near? Boxes of triangles by cubes of the grid.

#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/base/numbers/sort_unique.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct TriangleBox {
  glm::vec3 low, high;
  TriangleBox grown(float by) const { return {low - by, high + by}; }
  bool meets(const TriangleBox& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y &&
           low.z <= other.high.z && other.low.z <= high.z;
  }
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

/// Cubes of 8 steps that some boxes meet, a bit each: asking costs a few nanoseconds, so that a whole surface may.
class BrickSet {
 public:
  explicit BrickSet(std::span<const TriangleBox> boxes) {
    glm::ivec3 high(0);
    for (const TriangleBox& box : boxes) {
      low_ = &box == boxes.data() ? cell(box.low) : glm::min(low_, cell(box.low));
      high = &box == boxes.data() ? cell(box.high) : glm::max(high, cell(box.high));
    }
    if (boxes.empty()) return;
    size_ = high - low_ + 1;
    bits_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                 static_cast<std::size_t>(size_.z));
    for (const TriangleBox& box : boxes) each(box, [&](std::size_t i) { bits_[i] = true; });
  }
  bool meets(const TriangleBox& box) const {
    bool found = false;
    each(box, [&](std::size_t i) { found = found || bits_[i]; });
    return found;
  }

 private:
  static glm::ivec3 cell(const glm::vec3& p) { return glm::ivec3(glm::floor(p / 8.0f)); }
  template <class Body>
  void each(const TriangleBox& box, const Body& body) const {
    const glm::ivec3 first = glm::max(cell(box.low) - low_, glm::ivec3(0));
    const glm::ivec3 last = glm::min(cell(box.high) - low_, size_ - 1);
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x)
          body((static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(x));
  }

  glm::ivec3 low_{0}, size_{0};  ///< in cubes
  std::vector<bool> bits_;       ///< x first
};

/// Which triangles have some sides.
class SideTable {
 public:
  /// A side that is to be known.
  void want(std::uint32_t a, std::uint32_t b) { sides_[key(a, b)]; }
  /// Remembers a triangle at those of its sides that are wanted.
  void add(std::uint32_t id, const Triangle& t) {
    for (std::size_t i = 0; i < 3; ++i)
      if (const auto side = sides_.find(key(t[i], t[(i + 1) % 3])); side != sides_.end()) side->second.push_back(id);
  }
  /// Of a side that was wanted.
  const std::vector<std::uint32_t>& triangles(std::uint32_t a, std::uint32_t b) const { return sides_.at(key(a, b)); }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
  }
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> sides_;
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
    sort_unique(found);
  }

 private:
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cubes_;
};

}  // namespace dubsar
