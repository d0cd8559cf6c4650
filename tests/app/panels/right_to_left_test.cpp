// Letters as they are seen, against the forms that Unicode's charts give them.

#include "app/stage/right_to_left.h"

#include <gtest/gtest.h>

#include "app/panels/panel_font.h"
#include "display/render/images/utf8.h"

namespace dubsar::app {
namespace {

std::vector<unsigned> seen(const std::string& text, bool right_to_left = true) {
  return code_points(as_seen(text, right_to_left));
}

TEST(RightToLeft, TextsOfOtherScriptsStayAsTheyAre) {
  for (const std::string text : {"Hand schließen (12)", "", "\xff", "ša-ar-ru-um"}) {
    EXPECT_FALSE(has_right_to_left(text));
    EXPECT_EQ(as_seen(text, false), text);
    EXPECT_EQ(as_seen(text, true), text);
  }
}

TEST(RightToLeft, ArabicLettersAreJoinedAndStandFromTheRight) {
  // seen, lam, alef, meem: the first joins the ligature of the next two, the last stands alone.
  EXPECT_EQ(seen("سلام"), (std::vector<unsigned>{0xfee1, 0xfefc, 0xfeb3}));
  // beh, yeh, teh: at the beginning, in the middle, at the end.
  EXPECT_EQ(seen("بيت"), (std::vector<unsigned>{0xfe96, 0xfef4, 0xfe91}));
  // waw and reh join nothing that follows.
  EXPECT_EQ(seen("ورد"), (std::vector<unsigned>{0xfea9, 0xfead, 0xfeed}));
  // gaf and tcheh of Persian.
  EXPECT_EQ(seen("گچ"), (std::vector<unsigned>{0xfb7b, 0xfb94}));
}

TEST(RightToLeft, NumbersAndForeignWordsKeepTheirOrder) {
  EXPECT_EQ(seen("رقم 123"), (std::vector<unsigned>{'1', '2', '3', ' ', 0xfee2, 0xfed7, 0xfead}));
  EXPECT_EQ(as_seen("א PIN ב", true), "ב PIN א");
  EXPECT_EQ(as_seen("PIN אב", false), "PIN בא");
}

TEST(RightToLeft, HebrewIsTurnedAndBracketsFaceTheirWords) {
  EXPECT_EQ(as_seen("שלום", true), "םולש");
  EXPECT_EQ(as_seen("(אב) ג", true), "ג (בא)");
}

TEST(RightToLeft, LinesAreBrokenBeforeTheyAreTurned) {
  const auto fits = [](const std::string& line) { return code_points(line).size() <= 5; };
  EXPECT_EQ(lines_as_seen("אב גד הו", true, fits), (std::vector<std::string>{"דג בא", "וה"}));
  EXPECT_EQ(lines_as_seen("אבגדהוז ח", true, fits), (std::vector<std::string>{"זוהדגבא", "ח"}))
      << "too long for any line";
  EXPECT_TRUE(lines_as_seen("", true, fits).empty());
}

TEST(RightToLeft, AnythingThatIsNoTextIsNoReasonToCrash) {
  std::uint64_t state = 7;
  for (int i = 0; i < 2000; ++i) {
    std::string text;
    for (int k = 0; k < 1 + i % 40; ++k) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      text += utf8(static_cast<unsigned>(0x20 + (state >> 33) % 0x720));
      if (i % 3 == 0) text += static_cast<char>(static_cast<unsigned char>(state >> 40));
    }
    const std::string out = as_seen(text, i % 2 == 0);
    EXPECT_LE(code_points(out).size(), code_points(text).size());
  }
}

}  // namespace
}  // namespace dubsar::app
