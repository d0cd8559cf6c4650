// The mistakes that people make in files of JSON, each told with its place.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "core/base/text/json_text.h"

namespace dubsar {
namespace {

std::string said(std::string_view text) {
  const auto read = parse_json(text, "kiosk.json");
  return read ? "read" : read.error().message;
}

TEST(JsonFault, NamesLineColumnAndWhatIsWrong) {
  struct Case {
    std::string_view text, words;
  };
  for (const Case& c : {
           Case{"{\n \"version\": 1\n \"objects\": []\n}", "line 3, column 2: a comma is missing before \"objects\""},
           Case{"{\"a\": [1 2]}", "line 1, column 10: a comma is missing before 2"},
           Case{"{\"a\": {} \"b\": 1}", "line 1, column 10: a comma is missing before \"b\""},
           Case{"[{}\n{}]", "line 2, column 1: a comma is missing before {"},
           Case{"{\"a\": 1,\n}", "line 1, column 8: a comma too many before }"},
           Case{"[1, 2,\n]", "line 1, column 6: a comma too many before ]"},
           Case{"[1,, 2]", "line 1, column 4: a comma too many"},
           Case{"{\"a\": 1,,\"b\": 2}", "line 1, column 9: a comma too many"},
           Case{"{\n\"brightness\": 0,9\n}", "line 2, column 15: 0,9 found, expected a decimal point: 0.9"},
           Case{"{\"x\": -12,50, \"y\": 1}", "line 1, column 7: -12,50 found, expected a decimal point: -12.50"},
           Case{"{\n„a“: 1}", "line 2, column 1: the quote „ found, expected the straight \""},
           Case{"{\"a\": “b”}", "line 1, column 7: the quote “ found, expected the straight \""},
           Case{"{\"ü\": \"b”,\n\"c\": 1}", "line 1, column 9: the quote ” found, expected the straight \""},
           Case{"{'a': 1}", "line 1, column 2: the quote ' found, expected the straight \""},
           Case{"{\"a\": 1 // one\n}", "line 1, column 9: a comment found; JSON has none, take it out"},
           Case{"# words\n{}", "line 1, column 1: a comment found; JSON has none, take it out"},
           Case{"{\"a\" 1}", "line 1, column 6: a colon is missing after \"a\""},
           Case{"{\"a\" = 1}", "line 1, column 6: = found, expected a colon"},
           Case{"{\"a\": }", "line 1, column 7: the value of \"a\" is missing"},
           Case{"{name: 1}", "line 1, column 2: name found, expected a name in quotes: \"name\""},
           Case{"{\"a\": True}",
                "line 1, column 7: True found, expected true, false, null, a number or a text in quotes"},
           Case{"{\"a\": .5}", "line 1, column 7: .5 is no number of JSON, expected one such as 0.5, -3 or 1e-3"},
           Case{"{\"a\": 01}", "line 1, column 7: 01 is no number"},
           Case{"{\"a\": \"C:\\Users\"}", "line 1, column 10: a single \\ before U found in a text, expected \\\\"},
           Case{"{\"a\": \"b,\n\"c\": 1}", "line 1, column 7: the closing quote of \"b, ... is missing on its line"},
           Case{"{\"a\": \"b\tc\"}", "line 1, column 9: a control character (a tab) found in a text, expected \\t"},
           Case{"{\n\"a\": [1\n}", "line 3, column 1: } found, expected ], as [ opened at line 2"},
           Case{"\n{\"a\": 1", "line 2, column 8: the text ends before the } that closes the { of line 2"},
           Case{"[1]\n]", "line 2, column 1: ] found after the end of the text, expected nothing more"},
           Case{"{\"a\": 1e999}", "line 1, column 7: the number 1e999 is too large"},
           Case{"{\r\n\"a\": 1\r\n\"b\": 2}", "line 3, column 1: a comma is missing before \"b\""},
           Case{"{\r\"a\": 1\r\"b\": 2}", "line 3, column 1: a comma is missing before \"b\""},
           Case{"\xEF\xBB\xBF{\"a\" 1}", "line 1, column 6: a colon is missing after \"a\""},
           Case{"{\"a\": \"T\xE4"
                "fel\"}",
                "line 1, column 9: the byte E4 is not UTF-8; save the file as UTF-8"},
           Case{"{\"a\": \"\\ud800\"}", "line 1, column "},
       })
    EXPECT_NE(said(c.text).find("kiosk.json, " + std::string(c.words)), std::string::npos)
        << c.text << "\n"
        << said(c.text) << "\nwanted " << c.words;
}

TEST(JsonFault, TellsEmptyFilesAndOtherEncodings) {
  for (const std::string_view empty : {"", " \n\t", "\xEF\xBB\xBF"})
    EXPECT_EQ(said(empty), "kiosk.json: the file is empty, expected JSON");
  const std::string_view wide("\xFF\xFE{\0}\0", 6), wide_big(
                                                        "\0{\0\"\0a\0\"\0:\0"
                                                        "1\0}",
                                                        14);
  for (const std::string_view text : {wide, wide_big})
    EXPECT_EQ(said(text), "kiosk.json: the text is UTF-16, expected UTF-8; save the file as UTF-8");
}

TEST(JsonFault, EveryTruncationAndEveryChangedByteIsReadOrNamesAPlace) {
  const std::string whole = R"({"a": [1.5, -2e3, true, null], "b": {"c": "T\u00e4fel \"x\"", "d": []}, "e": "ä„“"})";
  const auto check = [](const std::string& text) {
    const auto read = parse_json(text, "f");
    if (read) return;
    const std::string& words = read.error().message;
    EXPECT_TRUE(words.starts_with("f, line ") || words.starts_with("f: the file is empty") ||
                words.starts_with("f: JSON is nested"))
        << text << "\n"
        << words;
    // The walk finds what the parser found: it never falls back on "no JSON that can be read" but for lone surrogates.
    EXPECT_TRUE(words.find("no JSON that can be read") == std::string::npos || text.find("\\ud") != std::string::npos)
        << text << "\n"
        << words;
  };
  for (std::size_t n = 0; n < whole.size(); ++n) check(whole.substr(0, n));
  std::mt19937 random(5);
  for (int i = 0; i < 20000; ++i) {
    std::string text = whole;
    text[random() % text.size()] = static_cast<char>(random() % 256 == 0 ? 1 : 1 + random() % 255);
    check(text);
  }
}

}  // namespace
}  // namespace dubsar
