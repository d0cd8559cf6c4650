#pragma once
// The ramp of filtered backprojection along rows of lanes.

#include <cstdint>
#include <vector>

#include "core/rays/lane_kernels.h"

namespace dubsar {

/// The exact ramp of a band-limited detector ([Kak 1988]) for rows of `bins` groups. Its weights are 1/4 at 0, -1 / (pi
/// n)^2 at odd distances n and 0 at the others. Of rows of 512 bins and more, what is farther than 64 to 128 bins is
/// taken from sums of 8 bins: the smooth -1 / (2 pi^2 n^2) stands there for the weights that alternate with 0, which is
/// the same but for waves of two bins.
class LaneRamp {
 public:
  explicit LaneRamp(std::int64_t bins);
  /// `row` becomes what the ramp makes of `in`; they do not overlap.
  void apply(const float* in, float* row) const;

 private:
  std::int64_t bins_, reach_, cells_ = 0;
  std::vector<float> near_;  ///< at distances 1, 3, 5, ...
  std::vector<float> far_;   ///< at distances of 0, 1, 2, ... cells
};

}  // namespace dubsar
