#include "core/edition/typed_letters.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

TEST(TypedLetters, BecomeThoseOfPrint) {
  const std::pair<const char*, const char*> cases[] = {
      {"a-szur", "a-\u0161ur"},
      {"s,i-il2-li2-{d}a-szur3", "\u1e63i-il\u2082-li\u2082-{d}a-\u0161ur\u2083"},
      {"t,up-pum", "\u1e6dup-pum"},
      {"a-h,i-a", "a-\u1e2bi-a"},
      {"SZU SZu Szu-{d}UTU", "\u0160U \u0160u \u0160u-{d}UTU"},
      {"KU3.BABBAR", "KU\u2083.BABBAR"},
      {"qi2-bi4-ma", "qi\u2082-bi\u2084-ma"},
      {"sag10-x12", "sag\u2081\u2080-x\u2081\u2082"},
      {"lax(LA) x (x) [x x]", "la\u2093(LA) x (x) [x x]"},
      {"|KAx(LA.LA)| KAx(ME)", "|KAx(LA.LA)| KAx(ME)"},
      {"1(disz) 5/6 sze 4(N57) 2(ban2)", "1(disz) 5/6 sze 4(N57) 2(ban\u2082)"},
      {"lu2@180 gud@g", "lu\u2082@180 gud@g"},
      {"%sux h,a %akk2 sza", "%sux \u1e2ba %akk2 \u0161a"},
      {"'a3-a a'a ma-'a3 re'um", "\u02bea\u2083-a a\u02bea ma-\u02bea\u2083 re\u02beum"},
      {"a' 3' ($___$)", "a' 3' ($___$)"},
      {"s'ar", "\u015bar"},
      {"", ""}};
  for (const auto& [typed, printed] : cases) {
    std::string expected = printed;
    if (const auto at = expected.find(" sze "); at != std::string::npos) expected.replace(at, 5, " \u0161e ");
    if (const auto at = expected.find("(disz)"); at != std::string::npos) expected.replace(at, 6, "(di\u0161)");
    EXPECT_EQ(typed_letters(typed), expected);
  }
}

TEST(TypedLetters, TypedBitByBitIsTheSameAndTwiceIsOnce) {
  std::mt19937 random(40104);
  const std::string keys = "szSZth,',ai2x(N)|-[ @%1KA3'";
  for (int n = 0; n < 40000; ++n) {
    std::string text, slowly;
    for (int k = std::uniform_int_distribution<int>(0, 14)(random); k > 0; --k) {
      const char key = keys[std::uniform_int_distribution<std::size_t>(0, keys.size() - 1)(random)];
      text += key;
      slowly = typed_letters(slowly + key);
    }
    ASSERT_EQ(slowly, typed_letters(text)) << text;
    ASSERT_EQ(typed_letters(slowly), slowly) << text;
  }
}

TEST(TypedLetters, GoBackToWhatWasTypedButForTheHook) {
  std::mt19937 random(40105);
  // Syllables of which each kind of letter has some; a capital SZ stands beside a capital.
  const char* const syllables[] = {"sza", "s,i2", "t,up", "qi2", "SZU",    "BABBAR3", "Sza", "lax(LA)",
                                   "x",   "[x]",  "{d}",  "'a3", "szur10", "1(ban)",  "s'u", "|KAxME|"};
  for (int n = 0; n < 5000; ++n) {
    std::string text;
    for (int k = std::uniform_int_distribution<int>(1, 8)(random); k > 0; --k)
      text += (text.empty() ? "" : k % 2 == 0 ? "-" : " ") + std::string(syllables[random() % std::size(syllables)]);
    EXPECT_EQ(ascii_letters(typed_letters(text)), text);
  }
  EXPECT_EQ(ascii_letters(typed_letters("a-h,i")), "a-hi");
}

}  // namespace
}  // namespace dubsar
