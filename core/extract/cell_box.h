#pragma once
// A vertex that moves stays inside the cell that it was made in: so polygons of different cells cannot cross
// (docs/manifold.md).

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>

namespace dubsar {

/// How near to a wall of its cell a vertex may come, grid steps: the step of EXA's escapes, 16 of exact places.
inline constexpr float kWallGap = 1.0f / 64.0f;

/// The place nearest to `wanted`, axis by axis, inside the cell of `start`, kWallGap from its walls or as near as
/// `start` is. Where `start` lies on a wall, in the caps at the border of the grid, it stays there.
inline glm::vec3 kept_in_cell(const glm::vec3& start, const glm::vec3& wanted) noexcept {
  glm::vec3 kept = wanted;
  for (int axis = 0; axis < 3; ++axis) {
    const auto whole = static_cast<float>(static_cast<std::int32_t>(start[axis]));  // std::floor() may be a call
    const float low = whole > start[axis] ? whole - 1.0f : whole;
    if (low == start[axis]) {
      kept[axis] = low;
      continue;
    }
    kept[axis] =
        std::clamp(kept[axis], std::min(low + kWallGap, start[axis]), std::max(low + (1.0f - kWallGap), start[axis]));
  }
  return kept;
}

}  // namespace dubsar
