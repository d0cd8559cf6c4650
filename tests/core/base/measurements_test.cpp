#include "core/base/numbers/measurements.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

TEST(Measurements, AreExactUntilTheyAreTooMany) {
  Measurements values;
  EXPECT_TRUE(values.empty());
  EXPECT_EQ(values.quantile(0.5), 0.0);
  EXPECT_EQ(values.quantile(1.0), 0.0);
  for (std::size_t i = Measurements::kMost; i > 0; --i) values.add(static_cast<double>(i));
  EXPECT_EQ(values.size(), Measurements::kMost);
  EXPECT_EQ(values.quantile(0.0), 1.0);
  EXPECT_EQ(values.quantile(0.5), 0.5 * Measurements::kMost);
  EXPECT_EQ(values.quantile(1.0), 1.0 * Measurements::kMost);
  Measurements below;
  below.add(-3.0);
  EXPECT_EQ(below.quantile(1.0), -3.0);
}

// Eight hours at 60 pictures a second. 0.01 is more than twice the standard deviation of a share of 16 384 values.
TEST(Measurements, OfADayTakeNoMoreMemoryAndAreAFairSample) {
  constexpr std::size_t kDay = 8 * 3600 * 60;
  Measurements values;
  for (std::size_t i = 0; i < kDay; ++i) values.add(i == kDay / 3 ? 5.0 : static_cast<double>(i) / kDay);
  EXPECT_EQ(values.size(), kDay);
  EXPECT_EQ(values.kept(), Measurements::kMost);
  for (const double p : {0.05, 0.25, 0.5, 0.75, 0.95}) EXPECT_NEAR(values.quantile(p), p, 0.01);
  EXPECT_EQ(values.quantile(1.0), 5.0) << "the largest of all, kept or not";
}

}  // namespace
}  // namespace dubsar
