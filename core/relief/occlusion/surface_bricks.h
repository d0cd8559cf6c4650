#pragma once
// A surface as signed distances at the corners of the cells that it passes, and elsewhere how far away it is: what rays
// march through fastest. The corners are kept in bricks of 4^3 cells, where the surface is.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Cells are cubes with an edge of one voxel; cell (0, 0, 0) begins at `origin`. Inside a cell the distance is
/// trilinear in those of its corners, 64 steps a voxel (so a sharp edge is rounded by about .2 voxel): positive on the
/// side that the triangles' normals point to. Bricks are 2^3 cells.
class SurfaceBricks {
 public:
  static constexpr int kEdge = 2;                         ///< cells
  static constexpr float kSteps = 64.0f;                  ///< of a corner's distance in a voxel
  static constexpr int kMostAhead = 32;                   ///< bricks
  static constexpr std::uint32_t kSurface = 0x80000000u;  ///< marks both words of bricks that the surface passes
  static constexpr int kCellBits = 23;  ///< of a cell's index in a word; above them a bit of each cell with surface

  /// Two words: where surface is kSurface, which of the cells have it (from bit kCellBits, x first), and of the first
  /// one's index into `corners` kCellBits bits in the first word, the others in the second. Else a byte for each octant
  /// of directions, from the lowest (1: x falls, 2: y, 4: z): the edge of the cube without surface that begins with
  /// this brick and lies that way, at most kMostAhead.
  using Brick = std::array<std::uint32_t, 2>;
  using Corners = std::array<std::int8_t, 8>;  ///< of a cell: corner x + 2 y + 4 z

  /// Any orientation and opening of the triangles; where a sheet ends its distances go on for at most two cells.
  /// Triangles with positions that are not finite are left out. kTryAgain: out of memory, or more than 2^31 cells or
  /// bytes of corners. Same bytes for any number of threads. Memory: a byte a cell, about 15 bytes a triangle, and
  /// while it is built 15 more.
  static Result<SurfaceBricks> build(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                                     Progress& progress);

  /// Of a brick, in `bricks`: 2^3 lie together, x first in both.
  std::size_t index_of(glm::ivec3 brick) const {
    const auto tile = (static_cast<std::size_t>(brick.z >> 1) * static_cast<std::size_t>(tiles.y) +
                       static_cast<std::size_t>(brick.y >> 1)) *
                          static_cast<std::size_t>(tiles.x) +
                      static_cast<std::size_t>(brick.x >> 1);
    return 8 * tile + static_cast<std::size_t>((brick.x & 1) | (brick.y & 1) << 1 | (brick.z & 1) << 2);
  }
  glm::ivec3 size() const { return 2 * tiles; }  ///< in bricks

  glm::vec3 origin{0.0f};  ///< in voxels, whole numbers
  glm::ivec3 tiles{0};     ///< of 2^3 bricks
  std::vector<Brick> bricks;
  std::vector<Corners> corners;  ///< and one more, so that there is one to read
};

}  // namespace dubsar
