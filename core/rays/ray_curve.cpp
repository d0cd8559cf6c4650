#include "core/rays/ray_curve.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

using Vector = std::array<double, RayCurve::kTerms>;
using Matrix = std::array<Vector, RayCurve::kTerms>;
using Chosen = std::array<bool, RayCurve::kTerms>;

/// The unknowns that are `chosen`, by Gauss' elimination with the largest pivot; the others are 0.
Vector solve(const Matrix& gram, const Vector& right, const Chosen& chosen) {
  Matrix a{};
  Vector b{};
  for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
    a[i][i] = 1.0;
    if (!chosen[i]) continue;
    b[i] = right[i];
    for (std::size_t j = 0; j < RayCurve::kTerms; ++j) a[i][j] = chosen[j] ? gram[i][j] : 0.0;
  }
  for (std::size_t k = 0; k < RayCurve::kTerms; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < RayCurve::kTerms; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    if (a[k][k] == 0.0) continue;
    for (std::size_t i = k + 1; i < RayCurve::kTerms; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < RayCurve::kTerms; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  Vector x{};
  for (std::size_t k = RayCurve::kTerms; k-- > 0;) {
    double sum = b[k];
    for (std::size_t j = k + 1; j < RayCurve::kTerms; ++j) sum -= a[k][j] * x[j];
    x[k] = a[k][k] != 0.0 ? sum / a[k][k] : 0.0;
  }
  return x;
}

}  // namespace

double RayCurve::value(double p, double s) const noexcept {
  double sum = 0.0;
  if (s > 0.0) {
    const double x = s * std::exp(absorbed * std::min(p, longest)) / stray_unit;
    sum = longest * x * (stray[0] + x * (stray[1] + x * x * stray[2]));
  }
  if (p <= 0.0) return sum + coefficients[0] * p;
  const double t = std::min(p / longest, 1.0);
  double plain = 0.0;
  for (std::size_t k = RayCurve::kTerms; k-- > 0;) plain = plain * t + coefficients[k];
  sum += plain * t * longest;
  return p > longest ? sum + (p - longest) * slope(longest, s) : sum;
}

double RayCurve::slope(double p, double s) const noexcept {
  const double t = std::clamp(p / longest, 0.0, 1.0);
  double sum = 0.0;
  for (std::size_t k = RayCurve::kTerms; k-- > 0;) sum = sum * t + static_cast<double>(k + 1) * coefficients[k];
  if (s > 0.0) {
    const double x = s * std::exp(absorbed * std::min(p, longest)) / stray_unit;
    sum += longest * absorbed * x * (stray[0] + x * (2.0 * stray[1] + 4.0 * x * x * stray[2]));
  }
  return sum;
}

bool RayCurve::bends() const noexcept {
  const auto positive = [](double c) { return c > 0.0; };
  return std::any_of(coefficients.begin() + 1, coefficients.end(), positive) ||
         std::any_of(stray.begin(), stray.end(), positive);
}

RayCurve RayCurve::in_steps_of(double voxels) const noexcept {
  RayCurve other = *this;
  other.longest /= voxels;
  other.absorbed *= voxels;
  return other;
}

Vector nonnegative_fit(const Matrix& gram, const Vector& right) {
  Vector x{};
  Chosen chosen{};
  double largest = 0.0;
  for (const double r : right) largest = std::max(largest, std::abs(r));
  // Each round takes in one unknown for good or drops one; thrice as many rounds as unknowns are known to be enough.
  for (std::size_t round = 0; round < 3 * RayCurve::kTerms; ++round) {
    std::size_t best = RayCurve::kTerms;
    double steepest = 1e-12 * largest;
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
      if (chosen[i]) continue;
      double down = right[i];
      for (std::size_t j = 0; j < RayCurve::kTerms; ++j) down -= gram[i][j] * x[j];
      if (down > steepest) steepest = down, best = i;
    }
    if (best == RayCurve::kTerms) break;
    chosen[best] = true;
    for (;;) {
      const Vector wanted = solve(gram, right, chosen);
      double part = 1.0;  // of the way to `wanted` before an unknown becomes negative
      for (std::size_t i = 0; i < RayCurve::kTerms; ++i)
        if (chosen[i] && wanted[i] <= 0.0) part = std::min(part, x[i] / (x[i] - wanted[i]));
      if (!(part < 1.0)) {
        x = wanted;
        break;
      }
      for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
        if (!chosen[i]) continue;
        x[i] += part * (wanted[i] - x[i]);
        if (wanted[i] <= 0.0 && x[i] <= 1e-14) x[i] = 0.0, chosen[i] = false;
      }
    }
  }
  return x;
}

}  // namespace dubsar
