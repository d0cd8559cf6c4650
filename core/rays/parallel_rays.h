#pragma once
// Slices of a volume and their projections along parallel rays, there and back (method `rays`): R and its inverse, for
// kLanes slices at once.

#include <cstdint>
#include <vector>

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

/// The directions and the detector for images of one size. Direction k is at the angle pi k / directions; the ray of
/// bin u has x cos + y sin = u - (bins - 1) / 2, x and y from the middle of the image, all in pixels. Thread-safe, uses
/// all threads; results do not depend on their number.
class ParallelRays {
 public:
  ParallelRays(std::int64_t width, std::int64_t height, std::int64_t directions);
  std::int64_t directions() const noexcept { return static_cast<std::int64_t>(cos_.size()); }
  std::int64_t bins() const noexcept { return bins_; }
  /// Place on the detector of the ray through the middle of the image, in bins.
  double middle() const noexcept { return 0.5 * static_cast<double>(bins_ - 1); }
  LaneImage image() const { return {width_, height_}; }
  LaneSinogram sinogram() const { return {directions(), bins_}; }

  /// R: line integrals in pixels ([Joseph 1982]).
  void project(const LaneImage& image, LaneSinogram& out) const;
  /// Prepares projections for backproject(): the exact ramp of a band-limited detector ([Kak 1988]), and what both
  /// linear interpolations take of the finest detail to second order, given back.
  void filter(LaneSinogram& projections) const;
  /// R^-1 of filtered projections.
  void backproject(const LaneSinogram& filtered, LaneImage& out) const;

 private:
  std::int64_t width_, height_, bins_;
  std::vector<double> cos_, sin_;
  std::vector<float> odd_;  ///< of the ramp at 1, 3, 5, ... bins
};

}  // namespace dubsar
