#include "core/rays/ray_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace dubsar {
namespace {

constexpr std::size_t kTerms = RayCurve::kTerms;

TEST(RayCurve, SlopeIsTheDerivativeAndGoesOnStraight) {
  const RayCurve curve{{1.02, 0.67, 0.0, 0.1, 0.0, 0.36}, 120.0};
  for (const double p : {0.0, 10.0, 60.0, 119.0, 120.5, 150.0})
    EXPECT_NEAR((curve.value(p + 1e-4) - curve.value(p - 1e-4)) / 2e-4, curve.slope(p), 2e-4) << p;
  EXPECT_DOUBLE_EQ(curve.value(120.0), 120.0 * (1.02 + 0.67 + 0.1 + 0.36));
  EXPECT_DOUBLE_EQ(curve.slope(200.0), curve.slope(120.0));
  EXPECT_DOUBLE_EQ(curve.contrast(), 1.02 / (1.02 + 2 * 0.67 + 4 * 0.1 + 6 * 0.36));
}

// I = e^-L + s gives p = -log(I): L = p - log(1 - s e^p), whose Taylor coefficients are 1, 1/2, 1/3 ...
TEST(RayCurve, ScatterAddsWhatItsFieldSays) {
  RayCurve curve{{1.0}, 4.0};
  curve.absorbed = 1.0;
  curve.stray_unit = std::exp(4.0) * 0.01;
  for (std::size_t k = 0; k < 3; ++k)
    curve.stray[k] = std::pow(curve.stray_unit, std::array{1.0, 2.0, 4.0}[k]) / (std::array{1.0, 2.0, 4.0}[k] * 4.0);
  curve.longest_stray = 0.01;
  for (const double p : {0.5, 2.0, 2.5}) {
    const double x = 0.01 * std::exp(p);
    EXPECT_NEAR(curve.value(p, 0.01), p - std::log1p(-x), 1.2 * x * x * x / 3.0) << p;  // but for the third power
    EXPECT_NEAR((curve.value(p + 1e-4, 0.01) - curve.value(p - 1e-4, 0.01)) / 2e-4, curve.slope(p, 0.01), 1e-5) << p;
    EXPECT_DOUBLE_EQ(curve.value(p), p);
  }
  const RayCurve half = curve.in_steps_of(0.5);
  EXPECT_NEAR(half.value(4.0, 0.01), 2.0 * curve.value(2.0, 0.01), 1e-12);
}

// Karush, Kuhn, Tucker: x is the minimum if and only if the gradient is 0 where x > 0 and not negative where x = 0.
TEST(NonnegativeFit, MeetsTheConditionsOfTheMinimum) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    std::array<std::array<double, kTerms>, 40> rows{};
    std::array<std::array<double, kTerms>, kTerms> gram{};
    std::array<double, kTerms> right{};
    for (auto& row : rows) {
      const double wanted = normal(random);
      for (double& value : row) value = normal(random) + 0.5;
      for (std::size_t i = 0; i < kTerms; ++i) {
        right[i] += row[i] * wanted;
        for (std::size_t j = 0; j < kTerms; ++j) gram[i][j] += row[i] * row[j];
      }
    }
    const std::array<double, kTerms> x = nonnegative_fit(gram, right);
    for (std::size_t i = 0; i < kTerms; ++i) {
      double gradient = -right[i];
      for (std::size_t j = 0; j < kTerms; ++j) gradient += gram[i][j] * x[j];
      ASSERT_GE(x[i], 0.0);
      if (x[i] > 0.0)
        ASSERT_NEAR(gradient, 0.0, 1e-9) << trial;
      else
        ASSERT_GE(gradient, -1e-9) << trial;
    }
  }
}

}  // namespace
}  // namespace dubsar
