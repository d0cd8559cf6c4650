#pragma once
// Rays of the sky from several vertices through the bricks of a surface, in vectors.

#include <array>
#include <cstddef>

#include "core/relief/occlusion/surface_bricks.h"

namespace dubsar::kernels {

/// Directions about +z and their weights; the arrays are borrowed.
struct Sky {
  const float *x, *y, *z, *weight;
  std::size_t count;
};

/// Where the rays of up to 32 vertices start, and their frames: a direction d of the sky goes to x d.x + y d.y + z d.z.
struct MarchStart {
  static constexpr std::size_t kMost = 32;
  using Values = std::array<float, kMost>;
  alignas(64) std::array<Values, 3> origin{};  ///< in voxels, as the positions of the surface
  alignas(64) std::array<Values, 9> frame{};   ///< x.x, x.y, x.z, y.x, ..., z.z
};

/// Of each start the sum over its rays of weight (1 - d / radius), d < radius the distance to the surface; d = 0 for
/// rays that come out of it, other than in their first voxel. Product and sum are kept apart: the same bits for all
/// targets.
void march(const SurfaceBricks& bricks, const Sky& sky, float radius_vox, const MarchStart& start,
           MarchStart::Values& taken);

}  // namespace dubsar::kernels
