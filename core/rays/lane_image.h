#pragma once
// Slices and projections of them, kLanes at once.

#include <cstdint>

#include "core/rays/lane_kernels.h"
#include "core/volume/volume.h"

namespace dubsar {

/// kLanes slices of the same size, pixel by pixel, with a margin of one pixel of zeros all round.
class LaneImage {
 public:
  LaneImage(std::int64_t width, std::int64_t height);
  std::int64_t width() const noexcept { return width_; }
  std::int64_t height() const noexcept { return height_; }
  std::int64_t row_stride() const noexcept { return (width_ + 2) * kernels::kLanes; }  ///< floats
  /// The group of pixel (x, y); x and y from -1 on.
  float* at(std::int64_t x, std::int64_t y) noexcept {
    return groups_.data() + (y + 1) * row_stride() + (x + 1) * kernels::kLanes;
  }
  const float* at(std::int64_t x, std::int64_t y) const noexcept {
    return groups_.data() + (y + 1) * row_stride() + (x + 1) * kernels::kLanes;
  }
  void clear();

 private:
  std::int64_t width_, height_;
  Buffer<float> groups_;
};

/// Projections of a LaneImage: one row a direction, `bins` groups each.
class LaneSinogram {
 public:
  LaneSinogram(std::int64_t directions, std::int64_t bins)
      : directions_(directions), bins_(bins), groups_(directions * bins * kernels::kLanes) {}
  std::int64_t directions() const noexcept { return directions_; }
  std::int64_t bins() const noexcept { return bins_; }
  std::int64_t row_floats() const noexcept { return bins_ * kernels::kLanes; }
  float* row(std::int64_t direction) noexcept { return groups_.data() + direction * row_floats(); }
  const float* row(std::int64_t direction) const noexcept { return groups_.data() + direction * row_floats(); }

 private:
  std::int64_t directions_, bins_;
  Buffer<float> groups_;
};

}  // namespace dubsar
