// What files of JSON have in common: a format with a version, and lists whose things have places.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/text/json_fields.h"
#include "core/base/text/json_text.h"

namespace dubsar {
namespace {
using nlohmann::json;

std::string said(const json& object, int oldest = 1, int newest = 1) {
  const auto version = json_version(object, "dubsar film", oldest, newest, "f.json");
  return version ? std::to_string(*version) : version.error().message;
}

TEST(JsonVersion, IsTakenWithinItsRangeAndRefusedInOneSentence) {
  EXPECT_EQ(said({{"format", "dubsar film"}, {"version", 1}}), "1");
  EXPECT_EQ(said({{"format", "dubsar film"}, {"version", 2}}, 1, 3), "2");
  const std::string other = "f.json: found other JSON, expected \"format\": \"dubsar film\"";
  EXPECT_EQ(said(json::array()), other);
  EXPECT_EQ(said({{"version", 1}}), other);
  EXPECT_EQ(said({{"format", "dubsar tour"}, {"version", 1}}), other);
  EXPECT_EQ(said({{"format", 7}, {"version", 1}}), other);
  const std::string end = " found, expected 1; a newer dubsar may have written it";
  EXPECT_EQ(said({{"format", "dubsar film"}}), "f.json: version none" + end);
  EXPECT_EQ(said({{"format", "dubsar film"}, {"version", 2}}), "f.json: version 2" + end);
  EXPECT_EQ(said({{"format", "dubsar film"}, {"version", 1.5}}), "f.json: version 1.5" + end);
  EXPECT_EQ(said({{"format", "dubsar film"}, {"version", {1, 2}}}), "f.json: version [1,2]" + end);
  EXPECT_EQ(said({{"format", "dubsar film"}, {"version", 4}}, 2, 3),
            "f.json: version 4 found, expected 2 to 3; a newer dubsar may have written it");
}

Result<int> whole(const json& thing, const std::string& where) {
  if (!thing.is_number_integer()) return fail(ErrorKind::kBadData, "{} is no whole number", where);
  return thing.get<int>();
}

std::string list_said(const json& object, std::size_t least) {
  const auto list = read_list<int>(object, "keys", least, 3, "f.json", whole);
  return list ? json(*list).dump() : list.error().message;
}

TEST(JsonList, ReadsEveryThingAndNamesThePlaceOfTheFirstThatIsWrong) {
  EXPECT_EQ(list_said({{"keys", {4, 5}}}, 1), "[4,5]");
  EXPECT_EQ(list_said(json::object(), 0), "[]");
  EXPECT_EQ(list_said({{"keys", {4, "a", "b"}}}, 0), "f.json: keys[1] is no whole number");
  EXPECT_EQ(list_said(json::object(), 1), "f.json: \"keys\" is no list of 1 to 3 keys");
  EXPECT_EQ(list_said({{"keys", json::array()}}, 1), "f.json: \"keys\" is no list of 1 to 3 keys");
  EXPECT_EQ(list_said({{"keys", {1, 2, 3, 4}}}, 0), "f.json: \"keys\" is no list of at most 3 keys");
  EXPECT_EQ(list_said({{"keys", 7}}, 0), "f.json: \"keys\" is no list of at most 3 keys");
}

}  // namespace
}  // namespace dubsar
