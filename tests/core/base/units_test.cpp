#include "core/base/units.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

TEST(Units, LengthsWithUnitsBecomeMillimetres) {
  EXPECT_DOUBLE_EQ(*parse_length_mm("38um"), 0.038);
  EXPECT_DOUBLE_EQ(*parse_length_mm("38 \xc2\xb5m"), 0.038);
  EXPECT_DOUBLE_EQ(*parse_length_mm(" 0.038 MM "), 0.038);
  EXPECT_DOUBLE_EQ(*parse_length_mm("3.8e-5m"), 0.038);
  EXPECT_DOUBLE_EQ(*parse_length_mm("2inch"), 50.8);
}

TEST(Units, ALengthWithoutUnitIsNeverGuessed) {
  for (const char* text : {"38", "", "um", "38 furlongs", "nan mm", "38umm"})
    EXPECT_FALSE(parse_length_mm(text)) << text;
}

}  // namespace
}  // namespace dubsar
