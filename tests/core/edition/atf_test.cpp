#include "core/edition/atf.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

// A text of our own with one line of each kind.
constexpr const char* kEachKind =
    "&P999001 = AO 0\n"
    "#project: ours/tests\n"
    "#atf: lang akk-x-oldass\n"
    "#atf: use unicode\n"
    "#link: def A = ours:Q999001 = another text\n"
    "\n"
    "@tablet\n"
    "@obverse?\n"
    "@column 2'\n"
    "$ beginning of obverse broken\n"
    "1'.\t[x x] a-na\n"
    "  \u0161u-mi\n"
    "#lem: x; x; ana[to]PRP\n"
    "#tr.en: [...] to\n"
    "#note: of the edge\n"
    ">>A 3\n"
    "== translated\n"
    "={ gloss\n"
    "# not for readers\n"
    "$ single ruling\n"
    "$ (not in the scan)\n"
    "@seal 1\n"
    "@edge b\n"
    "@colophon\n"
    "@m=locator catchline\n"
    "@envelope\n"
    "@reverse\n"
    "a+2-a+3'. x\n"
    "@translation labeled en project\n"
    "@label o 3 - o 4\n"
    "@(r 1) To my lord:\n"
    "speak. Thus he says.\n"
    "what is this?";

TEST(Atf, LinesKnowWhatTheyAre) {
  const AtfFile file = read_atf(kEachKind);
  std::string kinds;
  for (const AtfLine& line : file.lines) kinds += std::string(name_in(kAtfKinds, line.kind)) + " ";
  EXPECT_EQ(kinds,
            "text protocol protocol protocol protocol blank object surface column state line continued lemmas "
            "translation note link bilingual gloss comment state state seal surface part part object surface line "
            "translation-block translation-label translation-label translation-text translation-text ");
  EXPECT_EQ(file.lines[0].key, "P999001");
  EXPECT_EQ(file.lines[0].value, "AO 0");
  EXPECT_EQ(file.lines[1].key, "project");
  EXPECT_EQ(file.lines[1].value, "ours/tests");
  EXPECT_EQ(file.lines[7].key, "obverse");
  EXPECT_EQ(file.lines[7].flags, "?");
  EXPECT_EQ(file.lines[8].value, "2");
  EXPECT_EQ(file.lines[8].flags, "'");
  EXPECT_EQ(file.lines[9].value, "beginning of obverse broken");
  EXPECT_EQ(file.lines[10].key, "1'");
  EXPECT_EQ(file.lines[10].value, "[x x] a-na");
  EXPECT_EQ(file.lines[11].value, "\u0161u-mi");
  EXPECT_EQ(file.lines[13].key, "en");
  EXPECT_EQ(file.lines[13].value, "[...] to");
  EXPECT_EQ(file.lines[22].value, "b");
  EXPECT_EQ(file.lines[27].key, "a+2-a+3'");
}

TEST(Atf, AScoreHasManuscripts) {
  const AtfFile file = read_atf("&Q999001 = ours\n@score matrix parsed\n1. a-na\nA: a-[na]\nB o 2: [a]-na\n");
  EXPECT_EQ(file.lines[3].kind, AtfKind::kManuscript);
  EXPECT_EQ(file.lines[3].key, "A");
  EXPECT_EQ(file.lines[4].key, "B o 2");
  EXPECT_EQ(file.lines[4].value, "[a]-na");
}

TEST(Atf, WhatIsReadAndWrittenAgainIsTheSameForAnyBytes) {
  for (const std::string& text :
       {std::string(kEachKind), std::string(), std::string("\r\n\r\n"), std::string("\xef\xbb\xbf&P1"),
        std::string("1. a\r\n2. b\n3. c\r"), std::string("\n\n@\n$\n#\n&\n>>\n")})
    EXPECT_EQ(write_atf(read_atf(text)), text);
  std::mt19937 random(40102);
  const std::string bytes("&@$#>=<|{}[](). \t\r\n'1aP\xc5\xa1\xff\0", 27);
  for (int n = 0; n < 20000; ++n) {
    std::string text;
    for (int k = std::uniform_int_distribution<int>(0, 40)(random); k > 0; --k)
      text += bytes[std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random)];
    ASSERT_EQ(write_atf(read_atf(text)), text) << n;
    check_atf(read_atf(text));
  }
}

TEST(Atf, AMarkOfByteOrderAndOtherEndsDoNotHideWhatALineIs) {
  const AtfFile file = read_atf("\xef\xbb\xbf&P999001 = x\r\n1. a-na\r\n");
  EXPECT_EQ(file.lines[0].kind, AtfKind::kText);
  EXPECT_EQ(file.lines[0].key, "P999001");
  EXPECT_EQ(file.lines[1].end, "\r\n");
  EXPECT_EQ(file.lines[1].value, "a-na");
}

}  // namespace
}  // namespace dubsar
