#include "core/edition/line_number.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace dubsar {
namespace {

TEST(LineNumber, IsWhatTheGrammarsHave) {
  for (const char* good : {"1", "12", "3'", "3\u2032", "3''", "3a", "3'a", "a+1", "a+1'", "1-2", "1'-3'", "10a-10b"})
    EXPECT_TRUE(is_line_number(good)) << good;
  for (const char* bad : {"", "'", "a", "1.", "1 2", "3ab", "+1", "a1", "1-", "-1", "1-2-3", "i", "99999999999"})
    EXPECT_FALSE(is_line_number(bad)) << bad;
}

TEST(LineNumber, TheNextOneKeepsPrimesAndLeavesLettersBehind) {
  EXPECT_EQ(next_line_number("3"), "4");
  EXPECT_EQ(next_line_number("3'"), "4'");
  EXPECT_EQ(next_line_number("3\u2032"), "4'");
  EXPECT_EQ(next_line_number("3a"), "4");
  EXPECT_EQ(next_line_number("3'a"), "4'");
  EXPECT_EQ(next_line_number("a+3"), "a+4");
  EXPECT_EQ(next_line_number("1-2"), "3");
  EXPECT_EQ(next_line_number(""), "1");
  EXPECT_EQ(next_line_number("seal"), "1");
}

TEST(LineNumber, LinesAreInTheOrderInWhichTheyAreRead) {
  std::vector<std::string> lines{"10", "2", "1'", "2a", "x", "3-4", "1"};
  std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return is_line_before(a, b); });
  EXPECT_EQ(lines, (std::vector<std::string>{"1", "2", "2a", "3-4", "10", "1'", "x"}));
}

TEST(LineNumber, RomanNumeralsComeBack) {
  EXPECT_EQ(roman_number(4), "iv");
  EXPECT_EQ(roman_number(1994), "mcmxciv");
  EXPECT_EQ(roman_number(0), "");
  for (int n = 1; n < 400; ++n) EXPECT_EQ(number_of_roman(roman_number(n)), n);
  EXPECT_EQ(number_of_roman("iiii"), 0);
  EXPECT_EQ(number_of_roman(""), 0);
}

}  // namespace
}  // namespace dubsar
