#pragma once
// What a scan of the recipe has besides blur and noise: rings, cupping, streaks.

#include <cstdint>
#include <span>
#include <vector>

#include "core/phantom/options.h"

namespace dubsar::phantom {

/// All are fields over the grid, fixed by the options and the place of a voxel; the axis of rotation is z, through the
/// middle. In this order:
/// - cupping: clay counts less towards the axis, by `cupping` there and nothing at the rim of the ellipse that the grid
///   holds (a parabola of the radius, as hardening makes it in a cylinder: Brooks & Di Chiro, PMB 21 (1976) 390);
/// - streaks: lines in the slice through two dense points, dark with bright sides, in a few slices each;
/// - rings: gains of detector columns, each a little off.
class ScanArtefacts {
 public:
  explicit ScanArtefacts(const PhantomOptions& options);

  bool empty() const noexcept { return rings_.empty() && lines_.empty() && cupping_ <= 0.0; }
  /// Changes the row (y, z), densities from x = 0 on. Any thread.
  void apply(std::int64_t y, std::int64_t z, std::span<float> row) const;

 private:
  struct Line {  ///< of a streak; voxels
    double x, y, z, across_x, across_y, height;
  };

  Dims dims_;
  double cupping_ = 0.0;
  std::vector<float> rings_;  ///< by distance from the axis, density; empty: none
  std::vector<Line> lines_;   ///< by rising z
  double streak_height_ = 0.0;
};

}  // namespace dubsar::phantom
