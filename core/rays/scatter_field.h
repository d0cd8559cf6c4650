#pragma once
// Light that was scattered onto the detector, as the volume itself lets expect it.

#include <vector>

#include "core/rays/lane_planes.h"

namespace dubsar {

/// What a volume looks like along rays about an axis, coarsely: recorded lengths in voxels of that volume, some 60
/// cells a side and 48 directions over half a turn.
struct CoarseRays {
  std::int64_t directions = 0, planes = 0, bins = 0;
  double cell = 1.0;           ///< voxels
  double width = 0.0;          ///< of the wider side of a plane, voxels
  std::vector<float> lengths;  ///< bin by bin, plane by plane, direction by direction
};
CoarseRays look_coarsely(const Volume<float>& volume, TurnAxis axis, const GreyLevels& levels);

/// Scatter comes from where light is absorbed, I p for a ray of recorded length p and light I = e^-p; on the detector
/// it is spread by a Gauss ([Ohnesorge 1999]). In no unit: how much there is is fitted.
class ScatterField {
 public:
  /// `absorbed`: p of a voxel; `spread`: standard deviation in voxels.
  ScatterField(const CoarseRays& rays, double absorbed, double spread);

  double absorbed() const noexcept { return absorbed_; }
  double spread() const noexcept { return spread_; }
  /// The same field in steps of so many voxels.
  ScatterField in_steps_of(double voxels) const;

  /// The field along row `direction` of `all` for planes of a grid, as lanes: `bins` groups about the middle.
  void row(std::int64_t direction, std::int64_t all, std::span<const std::int64_t> planes, std::int64_t bins,
           float* out) const;

 private:
  const float* line(std::int64_t direction, std::int64_t plane) const noexcept {
    return field_.data() + (direction * planes_ + plane) * bins_;
  }
  std::int64_t directions_, planes_, bins_;
  double cell_, absorbed_, spread_;
  std::vector<float> field_;
};

}  // namespace dubsar
