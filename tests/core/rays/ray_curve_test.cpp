#include "core/rays/ray_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
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
