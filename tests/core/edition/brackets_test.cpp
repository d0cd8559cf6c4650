#include "core/edition/brackets.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {
using Kind = BracketFault::Kind;

TEST(Brackets, AreClosedInTheirLine) {
  for (const char* good : {"", "a-na {d}UTU", "[a-na] x", "a-n[a x]-x", "\u2e22a\u2e23-na", "[\u2e22a]-na\u2e23",
                           "szu(KA)", "<<a>> <na>", "($___$) x", "[(x)] (...)", "{{a-na}}", "|KAx(A.B)|", "<(a-na)>"})
    EXPECT_TRUE(bracket_faults(good).empty()) << good;
}

TEST(Brackets, FaultsSayWhereInCharacters) {
  EXPECT_EQ(bracket_faults("\u0161u [x"), (std::vector<BracketFault>{{4, "[", Kind::kNotClosed}}));
  EXPECT_EQ(bracket_faults("\u0161u x]"), (std::vector<BracketFault>{{5, "]", Kind::kNotOpened}}));
  EXPECT_EQ(bracket_faults("[a [b] c]"), (std::vector<BracketFault>{{4, "[", Kind::kNested}}));
  EXPECT_EQ(bracket_faults("\u2e22a"), (std::vector<BracketFault>{{1, "\u2e22", Kind::kNotClosed}}));
  EXPECT_EQ(bracket_faults("<<a>"),
            (std::vector<BracketFault>{{1, "<<", Kind::kNotClosed}, {4, ">", Kind::kNotOpened}}));
}

TEST(Brackets, ClosingThemLeavesNoneOpenAndChangesNothingElse) {
  EXPECT_EQ(with_brackets_closed("a-na [x (x"), "a-na [x (x)]");
  EXPECT_EQ(with_brackets_closed("x] a\u2e23"), "\u2e22[x] a\u2e23") << "the last to close was opened first";
  EXPECT_EQ(with_brackets_closed("a-na"), "a-na");
  std::mt19937 random(40101);
  const std::vector<std::string> tokens{"[", "]", "\u2e22", "\u2e23", "(", ")", "{", "}", "<", ">", "a", "\u0161", " "};
  const auto doubled = [](const std::string& text) {  // they are brackets of their own
    for (const char* pair : {"<<", ">>", "{{", "}}"})
      if (text.find(pair) != std::string::npos) return true;
    return false;
  };
  for (int n = 0; n < 20000; ++n) {
    std::string text;
    for (int k = std::uniform_int_distribution<int>(0, 12)(random); k > 0; --k)
      text += tokens[std::uniform_int_distribution<std::size_t>(0, tokens.size() - 1)(random)];
    const std::string closed = with_brackets_closed(text);
    if (doubled(closed)) continue;
    EXPECT_NE(closed.find(text), std::string::npos);
    for (const BracketFault& fault : bracket_faults(closed))
      EXPECT_EQ(fault.kind, Kind::kNested) << text << " " << closed;
  }
}

TEST(Brackets, TellWhatIsDamaged) {
  for (const char* damaged : {"[x]", "a-na#", "x \u2e22a\u2e23", "x] a"}) EXPECT_TRUE(tells_damage(damaged)) << damaged;
  for (const char* whole : {"a-na", "", "# x", "(x)", "<a>"}) EXPECT_FALSE(tells_damage(whole)) << whole;
}

}  // namespace
}  // namespace dubsar
