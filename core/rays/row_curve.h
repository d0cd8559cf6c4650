#pragma once
// A curve of rays, applied to rows of projections.

#include <span>
#include <vector>

#include "core/rays/ray_curve.h"
#include "core/rays/scatter_field.h"

namespace dubsar {

class RowCurve {
 public:
  /// `field`: where the curve has a part by scatter, in steps of the grid; kept by the caller.
  RowCurve(const RayCurve& curve, const ScatterField* field, std::int64_t directions, std::int64_t bins);

  /// g(p) / c_0 - p along row `direction` of planes of the grid, as lanes. Linear interpolation in tables: errors below
  /// 1e-6 of the longest ray. Thread-safe. `out` may be `p`.
  void bend(std::int64_t direction, std::span<const std::int64_t> planes, const float* p, float* out) const;

 private:
  struct Table {
    float first = 0.0F, per_length = 1.0F;
    std::vector<float> values;
    float at(float p) const noexcept;
  };
  RayCurve curve_;
  const ScatterField* field_;
  std::int64_t directions_, bins_;
  Table plain_, growth_;  ///< of what p alone adds; of e^(absorbed p) / stray_unit
};

}  // namespace dubsar
