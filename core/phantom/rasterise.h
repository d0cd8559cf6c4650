#pragma once
// From the model to voxels: bricks of 8 voxels that no surface touches are constant, the others are halved down to
// single voxels near the surface. What comes out depends on the place of the bricks in the grid only.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/phantom/phantom.h"

namespace dubsar::phantom {

struct VoxelBounds {
  std::array<std::int64_t, 3> lo, hi;  ///< [lo, hi), x y z
};

inline constexpr std::int64_t kBrickEdge = 8;
inline constexpr std::int64_t brick_of(std::int64_t voxel) {
  return voxel >= 0 ? voxel / kBrickEdge : -((kBrickEdge - 1 - voxel) / kBrickEdge);
}

/// No field grows faster than this per voxel near its surface (a test compares with voxel by voxel evaluation).
inline constexpr float kSteepest = 1.8f;

struct RasterRule {
  float band;       ///< voxels from a surface within which every voxel is evaluated
  bool interfaces;  ///< also along the invisible border between tablet and envelope, for labels
};

/// Calls constant(box, fields at its middle) or voxel(x, y, z, fields) for the part of a brick inside `clip`.
template <class Constant, class VoxelCall>
void visit_brick(const Phantom& phantom, const RasterRule& rule, std::array<std::int64_t, 3> lo, std::int64_t edge,
                 const VoxelBounds& clip, const Constant& constant, const VoxelCall& voxel) {
  VoxelBounds box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.lo[a] = std::max(lo[a], clip.lo[a]);
    box.hi[a] = std::min(lo[a] + edge, clip.hi[a]);
    if (box.lo[a] >= box.hi[a]) return;
  }
  const float middle = 0.5f * static_cast<float>(edge - 1);
  const float reach = kSteepest * (middle * 1.7320508f + rule.band);
  const Fields f = phantom.fields(static_cast<float>(lo[0]) + middle, static_cast<float>(lo[1]) + middle,
                                  static_cast<float>(lo[2]) + middle, reach + 0.1f);
  if (edge == 1) {
    voxel(lo[0], lo[1], lo[2], f);
    return;
  }
  float nearest = std::min({std::abs(f.clay.v), std::abs(f.organic.v), std::abs(f.grain.v)});
  if (rule.interfaces)
    nearest = std::min({nearest, std::abs(f.tablet.v), std::abs(f.outer.v), std::abs(f.wall.v), std::abs(f.pore.v),
                        std::abs(f.crack.v)});
  if (nearest > reach) {
    constant(box, f);
    return;
  }
  const std::int64_t half = edge / 2;
  for (std::int64_t k = 0; k < 8; ++k)
    visit_brick(phantom, rule, {lo[0] + (k & 1) * half, lo[1] + (k >> 1 & 1) * half, lo[2] + (k >> 2) * half}, half,
                clip, constant, voxel);
}

}  // namespace dubsar::phantom
