#include "core/edition/text_passages.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

constexpr const char* kLetter =
    "&P999001 = AO 0\n#project: ours\n#atf: lang akk-x-oldass\n@tablet\n@obverse\n$ 2 lines broken\n1'.\t[x]\ta-na\n"
    "#tr.en: to\n2'. um-ma\n  \u0161u-mi\n#lem: x; x\n@reverse\n@column 2\n1. x\n\n@envelope\n@obverse\n1. KI\u0160IB\n"
    "@translation labeled en project\n@label o 1'\nTo ...";

TEST(TextPassages, AreTheLinesWithTheirPlaces) {
  const auto found = passages_of(read_atf(kLetter));
  const std::vector<TextPassage> expected{{{"tablet", "obverse", 0, "1'"}, "[x]\ta-na", "to"},
                                          {{"tablet", "obverse", 0, "2'"}, "um-ma \u0161u-mi", ""},
                                          {{"tablet", "reverse", 2, "1"}, "x", ""},
                                          {{"envelope", "obverse", 0, "1"}, "KI\u0160IB", ""}};
  EXPECT_EQ(found, expected);
}

TEST(TextPassages, WhatNobodyChangedKeepsItsBytes) {
  const AtfFile base = read_atf(kLetter);
  EXPECT_EQ(write_atf(with_passages(base, record_of(base), passages_of(base))), kLetter);
  EXPECT_EQ(write_atf(with_passages(base, {}, {})), kLetter);
}

TEST(TextPassages, OneLineIsWrittenAnewAndTheOthersStay) {
  const AtfFile base = read_atf(kLetter);
  auto lines = passages_of(base);
  lines[1].text = "um-ma I-d\u00ed-A-\u0161\u00f9r";
  lines[0].translation = "to him";
  std::string expected = kLetter;
  expected.replace(expected.find("#tr.en: to\n"), 11, "#tr.en: to him\n");
  const std::string before = "2'. um-ma\n  \u0161u-mi\n";
  expected.replace(expected.find(before), before.size(), "2'. um-ma I-d\u00ed-A-\u0161\u00f9r\n");
  EXPECT_EQ(write_atf(with_passages(base, {}, lines)), expected);
}

TEST(TextPassages, NewLinesGoWhereTheyAreRead) {
  const AtfFile base =
      read_atf("&P999001 = AO 0\n@tablet\n@obverse\n1. a\n4. d\n#note: n\n@reverse\n2. y\n@left\n1. z");
  const std::vector<TextPassage> lines{
      {{"tablet", "left", 0, "2"}, "zz", ""},   {{"tablet", "obverse", 0, "3"}, "c", "see"},
      {{"tablet", "obverse", 0, "5"}, "e", ""}, {{"tablet", "bottom", 0, "1"}, "bb", ""},
      {{"tablet", "reverse", 0, "1"}, "x", ""}, {{"envelope", "obverse", 0, "1"}, "k", ""},
      {{"tablet", "obverse", 2, "1"}, "s", ""}};
  EXPECT_EQ(write_atf(with_passages(base, {}, lines)),
            "&P999001 = AO 0\n@tablet\n@obverse\n1. a\n3. c\n#tr.en: see\n4. d\n#note: n\n5. e\n@column 2\n1. "
            "s\n@bottom\n1. bb\n"
            "@reverse\n1. x\n2. y\n@left\n1. z\n2. zz\n@envelope\n@obverse\n1. k\n");
}

TEST(TextPassages, ATextOfItsOwnHasAHeadThatNothingIsMadeUpIn) {
  TabletRecord record;
  record.museum_number = "AO 8295";
  record.language = "akk-Latn-x-oldass";
  const std::vector<TextPassage> lines{{{"tablet", "reverse", 0, "1"}, "b", ""},
                                       {{"tablet", "obverse", 0, "1"}, "a", ""}};
  const AtfFile made = with_passages({}, record, lines);
  EXPECT_EQ(write_atf(made), "&X000001 = AO 8295\n#atf: lang akk-x-oldass\n@tablet\n@obverse\n1. a\n@reverse\n1. b\n");
  EXPECT_TRUE(check_atf(made).empty());
  record.p_number = "P999001";
  EXPECT_TRUE(write_atf(with_passages({}, record, lines)).starts_with("&P999001 = AO 8295\n"));
  EXPECT_EQ(passages_of(made), (std::vector<TextPassage>{lines[1], lines[0]}));
}

TEST(TextPassages, AnyLinesComeBack) {
  std::mt19937 random(40103);
  const auto any = [&](int most) { return std::uniform_int_distribution<int>(0, most)(random); };
  const char* const surfaces[] = {"obverse", "bottom", "reverse", "top", "left", "right", "edge b", "seal 1"};
  for (int n = 0; n < 500; ++n) {
    std::vector<TextPassage> lines;
    for (int k = any(12); k > 0; --k) {
      const TextSpot spot{any(3) == 0 ? "envelope" : "tablet", surfaces[any(7)], any(4) == 0 ? 1 + any(2) : 0,
                          std::to_string(1 + any(9)) + (any(2) == 0 ? "'" : "")};
      if (std::none_of(lines.begin(), lines.end(), [&](const auto& each) { return each.spot == spot; }))
        lines.push_back({spot, "a-na" + std::to_string(any(99)), any(2) == 0 ? "to" : ""});
    }
    const std::size_t half = lines.size() / 2;
    const AtfFile first = with_passages({}, {}, std::span(lines).first(half));
    const AtfFile both = read_atf(write_atf(with_passages(first, {}, lines)));
    std::stable_sort(lines.begin(), lines.end(),
                     [](const auto& a, const auto& b) { return is_read_before(a.spot, b.spot); });
    ASSERT_EQ(passages_of(both), lines) << write_atf(both);
    EXPECT_TRUE(check_atf(both).empty()) << write_atf(both);
  }
}

TEST(TextPassages, OfManyTextsTheOneOfTheRecordIsTaken) {
  const AtfFile file = read_atf("&P999001 = A\n1. a\n&P999002 = B\n1. b\n");
  TabletRecord record;
  EXPECT_EQ(
      text_of_atf(file, record, "f.atf").error().message,
      "f.atf holds 2 texts, and none of them is known to be this tablet's; say which with the command p_number, e.g. "
      "\"p_number P999001\"");
  record.p_number = "P999002";
  EXPECT_EQ(write_atf(text_of_atf(file, record, "f.atf").value()), "&P999002 = B\n1. b\n");
  record = {};
  record.museum_number = "A";
  EXPECT_EQ(write_atf(text_of_atf(file, record, "f.atf").value()), "&P999001 = A\n1. a\n");
  EXPECT_FALSE(text_of_atf(read_atf("1. a\n"), record, "f.atf"));
}

TEST(TabletRecord, NumbersAndLanguagesAreWrittenAsStandardsHaveThem) {
  EXPECT_EQ(catalogue_number("p293386").value(), "P293386");
  EXPECT_EQ(catalogue_number("293386").value(), "P293386");
  EXPECT_FALSE(catalogue_number("AO 8295"));
  EXPECT_EQ(language_tag("akk").value(), "akk-Latn");
  EXPECT_EQ(language_tag("Old Assyrian").value(), "akk-Latn-x-oldass");
  EXPECT_EQ(language_tag("SUX-latn").value(), "sux-Latn");
  EXPECT_EQ(language_tag("en").value(), "en");
  EXPECT_FALSE(language_tag("the language"));
  EXPECT_FALSE(language_tag(""));
  EXPECT_EQ(atf_language("akk-Latn-x-oldass"), "akk-x-oldass");
  EXPECT_EQ(tag_of_atf_language("akk-x-stdbab"), "akk-Latn-x-stdbab");
  TabletRecord record = record_of(read_atf("&P999001 = A\n#atf: lang sux\n1. a\n#tr.de: b\n"));
  EXPECT_EQ(record.p_number, "P999001");
  EXPECT_EQ(record.title, "A");
  EXPECT_EQ(record.language, "sux-Latn");
  EXPECT_EQ(record.translated, "de");
}

}  // namespace
}  // namespace dubsar
