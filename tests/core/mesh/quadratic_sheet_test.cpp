#include "core/mesh/quadratic_sheet.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace dubsar {
namespace {

constexpr SheetTerms kFactors{0.7, -1.3, 2.1, 0.4, -0.9, 1.6};

TEST(QuadraticSheet, FindsTheFactorsOfHeightsThatLieOnASheet) {
  std::mt19937 random(std::random_device{}());
  std::uniform_real_distribution<double> place(-1.0, 1.0), weight(0.1, 3.0);
  SheetEquations equations;
  for (int i = 0; i < 40; ++i) {
    const SheetTerms terms = sheet_terms(place(random), place(random));
    equations.add(terms, sheet_height(kFactors, terms), weight(random));
  }
  const auto found = equations.solved(1e-9);
  ASSERT_TRUE(found);
  for (std::size_t k = 0; k < kSheetTerms; ++k) EXPECT_NEAR((*found)[k], kFactors[k], 1e-9) << k;
}

TEST(QuadraticSheet, WeighsPlacesByTheirWeight) {
  SheetEquations equations;  // a level through heights 0 and 1 at the same places, of weights 1 and 3
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0}) {
      equations.add(sheet_terms(x, y), 0.0);
      equations.add(sheet_terms(x, y), 1.0, 3.0);
    }
  const auto found = equations.solved();
  ASSERT_TRUE(found);
  EXPECT_NEAR(sheet_height(*found, sheet_terms(0.3, -0.2)), 0.75, 1e-12);
}

TEST(QuadraticSheet, PlacesOnALineAreRefusedUnlessRegularized) {
  SheetEquations equations;
  for (int i = 0; i < 20; ++i) equations.add(sheet_terms(0.1 * i - 1.0, 0.0), 0.5);
  EXPECT_FALSE(equations.solved(1e-9));
  equations.regularize();
  const auto found = equations.solved();
  ASSERT_TRUE(found);
  EXPECT_NEAR(sheet_height(*found, sheet_terms(0.25, 0.0)), 0.5, 1e-6);
}

}  // namespace
}  // namespace dubsar
