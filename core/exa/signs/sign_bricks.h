#pragma once
// The bricks of a volume of signs (docs/exa.md, "Signs"): where they lie and what they know of each other.

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/exa/signs/sign_lattice.h"
#include "core/exa/signs/sign_surroundings.h"
#include "core/exa/signs/topology.h"

namespace dubsar {

/// Cells along an axis: whole cells of the top lattice, at least one.
inline std::int64_t padded_cells(std::int64_t points) { return std::max<std::int64_t>(1, (points + 6) / 8) * 8; }

struct Brick {
  std::array<std::int64_t, 3> low{};  ///< first point
  std::array<int, 3> cells{};         ///< finest cells
  bool late = false;                  ///< coded behind those beside it, whose points it knows
};
inline Brick brick_at(const Dims& dims, std::int64_t index) {
  const Dims grid = brick_grid(dims);
  const std::array<std::int64_t, 3> place{index % grid.x, index / grid.x % grid.y, index / grid.slice()};
  const std::array<std::int64_t, 3> points{dims.x, dims.y, dims.z};
  Brick brick;
  brick.late = (place[0] + place[1] + place[2]) % 2 != 0;
  for (std::size_t a = 0; a < 3; ++a) {
    brick.low[a] = place[a] * kBrickCells;
    brick.cells[a] = static_cast<int>(std::min<std::int64_t>(kBrickCells, padded_cells(points[a]) - brick.low[a]));
  }
  return brick;
}

/// `points`: those of spacing 2^level of a volume of `dims` points.
inline SignSurroundings surroundings_of(const Brick& brick, const BitVolume& points, int level, const Dims& dims) {
  return {points,    level,       dims,
          brick.low, brick.cells, {padded_cells(dims.x), padded_cells(dims.y), padded_cells(dims.z)}};
}

/// The corner signs of a brick, from the volume of every eighth point.
inline SignLattice top_lattice(const BitVolume& coarse, const Brick& brick) {
  SignLattice top({brick.cells[0] / 8, brick.cells[1] / 8, brick.cells[2] / 8});
  for (int z = 0; z <= top.cells()[2]; ++z)
    for (int y = 0; y <= top.cells()[1]; ++y)
      for (int x = 0; x <= top.cells()[0]; ++x)
        if (coarse.get(brick.low[0] / 8 + x, brick.low[1] / 8 + y, brick.low[2] / 8 + z)) top.set(x, y, z);
  return top;
}

}  // namespace dubsar
