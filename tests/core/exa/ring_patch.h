#pragma once
// A patch with several rims and closed pieces, as contact between tablet and envelope has them.

#include <algorithm>
#include <random>
#include <vector>

#include "core/parts/surface_model.h"

namespace dubsar {

/// Two bands of triangles, of 12 and 9 vertices around and 4 and 3 of their own across, each between two rims of
/// surface vertices (a rim of the first touches one of the second at a vertex), a tetrahedron and an octahedron; a
/// surface vertex lies within the first band, another one is a corner of the octahedron; all triangles in random order.
/// Vertices of its own lie on steps of 1 / 64.
inline FillPatch ring_patch(std::uint32_t vertex_count, unsigned seed) {
  std::mt19937 random(seed);
  FillPatch patch{0, 1, {}, {}};
  const auto own = [&](float x, float y, float z) {
    const auto step = [&](float v) { return v + static_cast<float>(random() % 16) / 64.0f; };
    patch.extra_positions.emplace_back(step(x), step(y), step(z));
    return vertex_count + static_cast<std::uint32_t>(patch.extra_positions.size()) - 1;
  };
  const auto band = [&](std::uint32_t around, std::uint32_t across, std::uint32_t first) {
    std::vector<std::vector<std::uint32_t>> rings(across + 2);
    for (std::uint32_t r = 0; r < rings.size(); ++r)
      for (std::uint32_t i = 0; i < around; ++i)
        rings[r].push_back(r == 0            ? first + i
                           : r == across + 1 ? first + around + i
                           : around == 12 && r == 2 && i == 4
                               ? 200
                               : own(static_cast<float>(r), static_cast<float>(i), 5.0f));
    for (std::size_t r = 0; r + 1 < rings.size(); ++r)
      for (std::size_t i = 0; i < around; ++i) {
        const std::size_t next = (i + 1) % around;
        patch.triangles.push_back({rings[r][i], rings[r][next], rings[r + 1][i]});
        patch.triangles.push_back({rings[r + 1][i], rings[r][next], rings[r + 1][next]});
      }
  };
  band(12, 4, 100);
  band(9, 3, 123);  // 123 is the last of the first band
  const auto solid = [&](std::initializer_list<Triangle> triangles, std::uint32_t corners) {
    const auto first = vertex_count + static_cast<std::uint32_t>(patch.extra_positions.size());
    for (std::uint32_t i = 0; i < corners; ++i) {
      const std::uint32_t row = i / 3;
      own(20.0f + static_cast<float>(i % 3), static_cast<float>(row), 9.0f);
    }
    for (const Triangle& t : triangles) patch.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  };
  solid({{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}, 4);
  solid({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {5, 2, 1}, {5, 3, 2}, {5, 4, 3}, {5, 1, 4}}, 6);
  patch.extra_positions.pop_back();  // the octahedron's last corner is a surface vertex
  for (Triangle& t : patch.triangles)
    std::replace(t.begin(), t.end(), vertex_count + static_cast<std::uint32_t>(patch.extra_positions.size()), 201u);
  std::shuffle(patch.triangles.begin(), patch.triangles.end(), random);
  for (Triangle& t : patch.triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
  return patch;
}

}  // namespace dubsar
