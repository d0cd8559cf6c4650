// Slips in hand-written JSON: all are told at their places in the text as it was written, and what is mended is JSON.

#include "core/base/text/json_mend.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "core/base/text/json_places.h"

namespace dubsar {
namespace {

TEST(JsonMend, TellsEverySlipAtItsPlaceInTheTextAsItWasWritten) {
  const std::string text =
      "{\"a\": 0,9\n \"b\": [1, 2,],  // two\n c: „x“,\n \"d\" 3,\n \"e\": \"C:\\data\",\n \"f\": True\n";
  const MendedJson mended = mend_json(text);
  ASSERT_TRUE(mended.whole) << mended.text;
  EXPECT_EQ(nlohmann::json::parse(mended.text),
            nlohmann::json::parse(R"({"a": 0.9, "b": [1, 2], "c": "x", "d": 3, "e": "C:\\data", "f": true})"));
  std::vector<std::string> places;
  for (const JsonFault& fault : mended.faults) places.push_back(json_place(text, fault.at));
  EXPECT_EQ(places,
            (std::vector<std::string>{"line 1, column 7", "line 2, column 2", "line 2, column 12", "line 2, column 17",
                                      "line 3, column 2", "line 3, column 5", "line 4, column 6", "line 5, column 10",
                                      "line 6, column 7", "line 7, column 1"}));
}

TEST(JsonMend, EndsAndMapsItsPlacesWhateverTheBytesAre) {
  std::mt19937 random(2026);
  const std::string good = R"({"a": [1, 2.5, {"b": "c\n"}], "ü": true, "d": {"e": null}})";
  for (int i = 0; i < 3000; ++i) {
    std::string text = good;
    for (int n = 0; n < 1 + i % 4; ++n) {
      const std::size_t at = random() % text.size();
      if (i % 3 == 0) text.erase(at, 1 + random() % 3);
      if (i % 3 == 1) text.insert(at, 1, "\",:{}[];'/\\\n\xE4x0"[random() % 16]);
      if (i % 3 == 2) text[at] = static_cast<char>(random() % 256);
      if (text.empty()) text = " ";
    }
    const MendedJson mended = mend_json(text);
    for (const JsonFault& fault : mended.faults) ASSERT_LE(fault.at, text.size()) << text;
    for (std::size_t at = 1; at <= mended.text.size(); ++at)
      ASSERT_LE(mended.given_at(at), text.size()) << text << "\n" << mended.text;
    ASSERT_TRUE(!mended.whole || (mended.text == text) == mended.faults.empty()) << text;
    JsonPlaces(mended.text).at("/a/2/b");
    JsonPlaces(text).at("/a/2/b");
  }
}

TEST(JsonPlaces, KnowsWhereMembersAndThingsOfListsBeginAndWhatIsThereTwice) {
  const std::string text = "{\"a\": [1, {\"b/c\": 2}],\n \"\\u00fc\": 3, \"a\": 4}";
  const JsonPlaces places(text);
  EXPECT_EQ(places.at("/a/1"), text.find("{\"b"));
  EXPECT_EQ(places.at("/ü"), text.find("\"\\u"));
  EXPECT_EQ(places.end("/ü"), text.find(", \"a\": 4"));
  EXPECT_EQ(places.at("/a/1/missing"), text.find("{\"b"));
  EXPECT_EQ(places.at("/none"), 0U);
  EXPECT_EQ(places.repeated(), std::vector<std::string>{"/a"});
}

}  // namespace
}  // namespace dubsar
