#pragma once
// Slices of a volume and their projections along parallel rays, there and back (method `rays`): R and its inverse, for
// kLanes slices at once.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/rays/lane_image.h"
#include "core/rays/lane_ramp.h"
#include "core/rays/tiled_rays.h"

namespace dubsar {

/// The directions and the detector for images of one size. Direction k is at the angle pi k / directions; the ray of
/// bin u has x cos + y sin = u - (bins - 1) / 2, x and y from the middle of the image, all in pixels. Thread-safe, uses
/// all threads; results do not depend on their number.
class ParallelRays {
 public:
  ParallelRays(std::int64_t width, std::int64_t height, std::int64_t directions);
  std::int64_t directions() const noexcept { return static_cast<std::int64_t>(cos_.size()); }
  std::int64_t bins() const noexcept { return bins_; }
  /// Directions that are taken together where a large image is projected or backprojected: 1 of small ones.
  static std::int64_t directions_together(std::int64_t directions) noexcept;
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
  LaneRamp ramp_;
  std::optional<TiledRays> tiled_;  ///< of large images
};

}  // namespace dubsar
