#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/edition/atf.h"

namespace dubsar {
namespace {

/// "LINE:COLUMN message", with ~ before warnings.
std::vector<std::string> faults_of(std::string_view text) {
  std::vector<std::string> out;
  for (const AtfFault& fault : check_atf(read_atf(text)))
    out.push_back(fmt::format("{}{}:{} {}", fault.only_warning ? "~" : "", fault.line, fault.column, fault.message));
  return out;
}
std::string only_fault(const std::string& lines) {
  const auto found = faults_of("&P999001 = AO 0\n@tablet\n@obverse\n" + lines);
  return found.size() == 1 ? found[0]
                           : fmt::format("{} faults, first: {}", found.size(), found.empty() ? "" : found[0]);
}

TEST(AtfCheck, AGoodTextHasNoFaults) {
  EXPECT_EQ(
      faults_of("&X000001 = AO 0\n#project: ours\n#atf: lang akk\n@tablet\n@obverse\n$ 3 lines broken\n1'. a-[na]\n"
                "#lem: ana[to]PRP\n#tr.en: to\n2'. [...]\n$ (not in the scan)\n@column 2\n1'. x\n@reverse'?\n"
                "$ reverse blank\n@seal 1\n@envelope\n@obverse\n1. KISZIB3\n"),
      std::vector<std::string>());
}

TEST(AtfCheck, FaultsSayLineAndColumnWhatWasFoundAndWhatIsExpected) {
  EXPECT_EQ(only_fault("1. a-na [x\n"), "4:9 [ is not closed in this line");
  EXPECT_EQ(only_fault("1. \u0161u x]\n"), "4:8 ] closes nothing");
  EXPECT_EQ(
      only_fault("@obvers\n"),
      "4:2 \"@obvers\" found, expected @tablet, @obverse, @reverse, @column 1 or the like; did you mean \"obverse\"?");
  EXPECT_EQ(only_fault("a-na\n"),
            "4:1 this is no line of ATF; expected a number with a point as in \"1. a-na\", or one of & @ $ # in front");
  EXPECT_EQ(only_fault("@column\n"), "4:1 \"@column \" found, expected a number as in \"@column 2\"");
  EXPECT_EQ(only_fault("1. a-na\xff\n"), "4:8 byte ff found, expected text in UTF-8");
  EXPECT_EQ(only_fault("== x\n"), "4:1 a bilingual found where no numbered line stands above it");
  EXPECT_EQ(only_fault("@left side\n"), "4:7 \"@left\" is followed by \"side\", expected nothing or one of ' ? ! *");
  EXPECT_EQ(faults_of("1. a\n")[0],
            "1:1 this stands before any text; expected first a line such as \"&P123456 = AO 8295\"");
  EXPECT_EQ(faults_of("&P12 = AO 0\n")[0],
            "1:2 \"P12\" found, expected P, Q or X and six digits, as in \"&P123456 = AO 8295\"");
}

TEST(AtfCheck, WhatSomeProgramsReadIsAWarning) {
  EXPECT_EQ(only_fault("1. a\n1. b\n"), "~5:1 line 1 stands twice on this side");
  EXPECT_EQ(only_fault("$ beginning broken\n"),
            "~4:3 \"$ beginning broken\" found, expected a state such as \"$ 3 lines broken\", \"$ rest of obverse "
            "missing\", "
            "\"$ single ruling\", or free text in parentheses");
  EXPECT_EQ(only_fault("1.2. a\n"), "~4:1 line number \"1.2\" found, expected 3, 3', 3a, a+3 or 3-4");
}

TEST(AtfCheck, StatesOfTheGrammarAreKnown) {
  for (const char* strict :
       {"broken", "3 lines broken", "2-3 lines missing", "at least 3 lines traces", "about 2 columns broken",
        "rest of obverse missing", "beginning of reverse broken", "reverse blank", "several lines illegible?",
        "single ruling", "double ruling!", "seal 1", "rest of column 2 broken", "edge b blank", "1 line traces *"})
    EXPECT_EQ(atf_state_form(strict), AtfStateForm::kStrict) << strict;
  for (const char* free : {"(not in the scan)", "(seal 1)", "(image 1 = a lion)"})
    EXPECT_EQ(atf_state_form(free), AtfStateForm::kFree) << free;
  for (const char* wrong : {"", "beginning broken", "lacuna", "3 broken lines", "at 3 lines", "rest of", "seal"})
    EXPECT_EQ(atf_state_form(wrong), AtfStateForm::kWrong) << wrong;
}

}  // namespace
}  // namespace dubsar
