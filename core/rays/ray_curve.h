#pragma once
// What a ray through a length of clay was recorded as, and what it would have been without scatter and hardening.

#include <array>
#include <cstddef>
#include <cstdint>

namespace dubsar {

/// g(p) = sum over k of coefficients[k] p (p / longest)^k: the straight length of a ray from its recorded one, both in
/// voxels of clay. Coefficients are >= 0, as scatter and hardening make them: 1 / (1 - s e^p) and the inverse of a
/// concave curve have positive Taylor coefficients.
struct RayCurve {
  static constexpr std::size_t kTerms = 6;
  std::array<double, kTerms> coefficients{1.0};
  double longest = 1.0;  ///< p up to which the curve was found; beyond it goes on straight

  double value(double p) const noexcept;
  double slope(double p) const noexcept;
  /// Share of its contrast with which a detail on a ray of recorded length p arrives.
  double contrast(double p) const noexcept { return coefficients[0] / slope(p); }
};

/// Least squares with x >= 0 ([Lawson 1974]): minimises
/// x^T gram x - 2 x^T right. `gram` is symmetric and not negative definite.
std::array<double, RayCurve::kTerms> nonnegative_fit(
    const std::array<std::array<double, RayCurve::kTerms>, RayCurve::kTerms>& gram,
    const std::array<double, RayCurve::kTerms>& right);

}  // namespace dubsar
