#include "core/base/text/parse_number.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>

namespace dubsar {
namespace {

TEST(ParseNumber, EveryDoubleComesBackAndNothingElseDoes) {
  std::mt19937_64 random(20261122);
  int finite = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint64_t bits = random();
    double value;
    static_assert(sizeof value == sizeof bits);
    std::memcpy(&value, &bits, sizeof value);
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    const auto read = parse_number({text, static_cast<std::size_t>(end - text)});
    if (!std::isfinite(value)) {
      EXPECT_FALSE(read);
      continue;
    }
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, value);
    ++finite;
  }
  EXPECT_GT(finite, 90000);
  for (const char* bad : {"", " ", "1 ", " 1", "1x", "1,", "0x10", "nan", "NaN", "inf", "-inf", "infinity", "1e999",
                          "-1e999", "1e", "+-1", "--1", "1.2.3", "1,5"})
    EXPECT_FALSE(parse_number(bad)) << bad;
}

TEST(ParseNumber, WholeNumbersHaveNoPointAndFitAnInt) {
  for (const int good : {0, -1, 42, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()})
    EXPECT_EQ(parse_whole(std::to_string(good)), good);
  for (const char* bad : {"", "1.0", "1e3", "2147483648", "-2147483649", "12px", "0x1f", " 3"})
    EXPECT_FALSE(parse_whole(bad)) << bad;
}

TEST(ParseNumber, VectorsHaveExactlyTheirNumbers) {
  EXPECT_EQ(parse_numbers<3>("30,-0.5,6e2"), (std::array{30.0, -0.5, 600.0}));
  EXPECT_EQ(parse_numbers<2>("344x194", 'x'), (std::array{344.0, 194.0}));
  EXPECT_EQ(parse_numbers<1>("7"), (std::array{7.0}));
  for (const char* bad : {"", "1,2", "1,2,3,", "1,2,3,4", "1,,3", "1,2,3x", "1,nan,3", "1;2;3", "1, 2, 3"})
    EXPECT_FALSE(parse_numbers<3>(bad)) << bad;
}

TEST(ParseNumber, SizesAreTwoWholeNumbersWithACross) {
  EXPECT_EQ(parse_size("960x540"), (std::array{960, 540}));
  for (const char* bad :
       {"", "960", "960x", "x540", "960x540x", "960x540x2", "960X540", "960 x 540", "9e2x540", "1.5x2"})
    EXPECT_FALSE(parse_size(bad)) << bad;
}

}  // namespace
}  // namespace dubsar
