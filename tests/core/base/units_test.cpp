#include "core/base/numbers/units.h"

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

TEST(Units, SizesArePowersOf1024) {
  EXPECT_EQ(*parse_bytes("6G"), std::uint64_t{6} << 30);
  EXPECT_EQ(*parse_bytes("6 GiB"), std::uint64_t{6} << 30);
  EXPECT_EQ(*parse_bytes("512m"), std::uint64_t{512} << 20);
  EXPECT_EQ(*parse_bytes("1.5T"), std::uint64_t{3} << 39);
  EXPECT_EQ(*parse_bytes("4096"), 4096U);
  for (const char* text : {"", "G", "-6G", "0", "6 apples", "nan", "inf", "1e30T", "6GG"})
    EXPECT_FALSE(parse_bytes(text)) << text;
}

}  // namespace
}  // namespace dubsar
