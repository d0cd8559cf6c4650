#pragma once
// The relief a cylinder seal leaves in clay: a presentation scene, repeated as the seal rolls on.

#include <cstdint>
#include <vector>

#include "core/phantom/dual.h"

namespace dubsar::phantom {

/// Height field periodic in x (one turn of the seal) and 0 outside 0..height in y, as a C2 uniform cubic B-spline.
class SealRelief {
 public:
  SealRelief() = default;
  /// A scene drawn with figures in places that depend on the seed: enthroned deity, worshippers, bull, star, crescent,
  /// altar, between border lines.
  explicit SealRelief(std::uint64_t seed);

  static constexpr float kTurnMm = 38.0f;    ///< circumference
  static constexpr float kHeightMm = 17.0f;  ///< length of the seal
  static constexpr float kReliefMm = 0.50f;  ///< highest point of a figure over the ground

  /// Height over the ground in mm at (x, y) in mm; the gradient follows from those of x and y.
  Dual height(const Dual& x_mm, const Dual& y_mm) const;

 private:
  static constexpr int kColumns = 380, kRows = 170;
  std::vector<float> nodes_;  ///< kColumns x kRows
};

}  // namespace dubsar::phantom
