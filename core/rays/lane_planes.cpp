#include "core/rays/lane_planes.h"

#include "core/base/system/parallel.h"

namespace dubsar {

using kernels::kLanes;

PlaneStrides planes_across(const Dims& dims, TurnAxis axis) noexcept {
  switch (axis) {
    case TurnAxis::kX:
      return {dims.y, dims.z, dims.x, dims.x, dims.slice(), 1};
    case TurnAxis::kY:
      return {dims.x, dims.z, dims.y, 1, dims.slice(), dims.x};
    case TurnAxis::kZ:
      break;
  }
  return {dims.x, dims.y, dims.z, 1, dims.x, dims.slice()};
}

void load_planes(const float* voxels, const PlaneStrides& at, std::span<const std::int64_t> planes,
                 const GreyLevels& levels, LaneImage& out) {
  const auto scale = static_cast<float>(1.0 / levels.contrast()), air = static_cast<float>(levels.air);
  parallel_for(at.height, 4, [&](std::int64_t y) {
    float* const row = out.at(0, y);
    std::fill(row, row + at.width * kLanes, 0.0F);
    for (std::size_t lane = 0; lane < planes.size(); ++lane) {
      const float* from = voxels + planes[lane] * at.to_next + y * at.along_height;
      for (std::int64_t x = 0; x < at.width; ++x)
        row[x * kLanes + static_cast<std::int64_t>(lane)] = (from[x * at.along_width] - air) * scale;
    }
  });
}

void add_planes(const LaneImage& image, const PlaneStrides& at, std::span<const std::int64_t> planes, float scale,
                float* voxels) {
  parallel_for(at.height, 4, [&](std::int64_t y) {
    const float* const row = image.at(0, y);
    for (std::size_t lane = 0; lane < planes.size(); ++lane) {
      float* to = voxels + planes[lane] * at.to_next + y * at.along_height;
      for (std::int64_t x = 0; x < at.width; ++x)
        to[x * at.along_width] += scale * row[x * kLanes + static_cast<std::int64_t>(lane)];
    }
  });
}

}  // namespace dubsar
