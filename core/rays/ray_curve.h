#pragma once
// What a ray through a length of clay was recorded as, and what it would have been without scatter and hardening.

#include <array>
#include <cstddef>
#include <cstdint>

namespace dubsar {

/// g(p) = sum over k of coefficients[k] p (p / longest)^k + longest (stray[0] x + stray[1] x^2 + stray[2] x^4), x = s
/// e^(absorbed p) / stray_unit: the straight length of a ray from its recorded one, both in voxels of clay, where
/// scatter is s (ScatterField). Coefficients are >= 0, as scatter and hardening make them: -log(1 - x) and the inverse
/// of a concave curve have positive Taylor coefficients.
struct RayCurve {
  static constexpr std::size_t kTerms = 6;
  static constexpr std::size_t kStrayTerms = 3, kPlainTerms = kTerms - kStrayTerms;  ///< where there is a stray field
  std::array<double, kTerms> coefficients{1.0};
  double longest = 1.0;  ///< p up to which the curve was found; beyond it goes on straight
  std::array<double, kStrayTerms> stray{};
  double absorbed = 0.0;       ///< of light by a voxel of clay
  double stray_unit = 1.0;     ///< x <= 1 for the rays that it was found by
  double longest_stray = 0.0;  ///< s of the longest of them

  double value(double p, double s = 0.0) const noexcept;
  double slope(double p, double s = 0.0) const noexcept;  ///< by p
  /// Whether any ray is longer than it was recorded.
  bool bends() const noexcept;
  /// Share of its contrast with which a detail on the longest ray arrives.
  double contrast() const noexcept { return slope(0.0) / slope(longest, longest_stray); }
  /// The same curve where lengths are counted in steps of so many voxels.
  RayCurve in_steps_of(double voxels) const noexcept;
};

/// Least squares with x >= 0 ([Lawson 1974]): minimises
/// x^T gram x - 2 x^T right. `gram` is symmetric and not negative definite.
std::array<double, RayCurve::kTerms> nonnegative_fit(
    const std::array<std::array<double, RayCurve::kTerms>, RayCurve::kTerms>& gram,
    const std::array<double, RayCurve::kTerms>& right);

}  // namespace dubsar
