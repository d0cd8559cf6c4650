#pragma once
// Planes of a volume perpendicular to one of its axes, kLanes at a time, as images of rays (parallel_rays.h).

#include <cstdint>
#include <span>

#include "core/rays/parallel_rays.h"

namespace dubsar {

/// The axis of the volume about which the scanner turned.
enum class TurnAxis { kX, kY, kZ };

/// Where pixels of such planes lie in an array of x-fastest voxels.
struct PlaneStrides {
  std::int64_t width = 0, height = 0, planes = 0;
  std::int64_t along_width = 0, along_height = 0, to_next = 0;  ///< in voxels
};
PlaneStrides planes_across(const Dims& dims, TurnAxis axis) noexcept;

/// Grey values of air and clay.
struct GreyLevels {
  double air = 0.0, clay = 1.0;
  double contrast() const noexcept { return clay - air; }
};

/// Lane k becomes plane `planes[k]` in units of clay, air 0; lanes without a plane become 0.
void load_planes(const float* voxels, const PlaneStrides& at, std::span<const std::int64_t> planes,
                 const GreyLevels& levels, LaneImage& out);

/// Adds `scale` times lane k to plane `planes[k]`.
void add_planes(const LaneImage& image, const PlaneStrides& at, std::span<const std::int64_t> planes, float scale,
                float* voxels);

}  // namespace dubsar
