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
/// side that the triangles' normals point to.
class SurfaceBricks {
 public:
  static constexpr int kEdge = 4;              ///< cells
  static constexpr float kSteps = 64.0f;       ///< of a corner's distance in a voxel
  static constexpr std::uint8_t kNone = 0xff;  ///< marks cells without surface
  static constexpr int kMostAway = 31;         ///< blocks

  /// Which cells of a brick have surface, x first: their places behind first_cell, or kNone.
  struct Brick {
    std::uint32_t first_cell;  ///< index into `corners`
    std::array<std::uint8_t, std::size_t{kEdge} * kEdge * kEdge> cells;
  };
  using Corners = std::array<std::int8_t, 8>;  ///< of a cell: corner x + 2 y + 4 z

  /// Any orientation and opening of the triangles; where a sheet ends its distances go on for at most two cells.
  /// Triangles with positions that are not finite are left out. Blocks are cells, or 2^3 cells where those are more
  /// than 10^9. kTryAgain: out of memory, or more than 2^31 blocks or bytes of corners. Same bytes for any number of
  /// threads. Memory: a byte a block, about 15 bytes a triangle, and while it is built 15 more.
  static Result<SurfaceBricks> build(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                                     Progress& progress);

  glm::vec3 origin{0.0f};  ///< in voxels, whole numbers
  glm::ivec3 size{0};      ///< in bricks
  int block_bits = 0;      ///< a block has 2^block_bits cells each way
  /// Of each block, 4^3 of them together, x first in both: 0 where surface is, else k <= kMostAway: none in the blocks
  /// nearer than k (the largest of the differences of their places). Then three bytes more.
  std::vector<std::uint8_t> away;
  std::vector<std::int32_t> table;  ///< of each brick, x first: its index in `bricks`, or -1: without surface
  std::vector<Brick> bricks;
  std::vector<Corners> corners;
};

}  // namespace dubsar
