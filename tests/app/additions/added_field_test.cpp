// A field of sessions that the program does not have, in two files: kept, read again, and missing in older files.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/document/document_file.h"

namespace dubsar::app {
namespace {

TEST(AddedField, IsKeptInSessionsAndOlderOnesAreReadWithoutIt) {
  Document document;
  document.dust = 0.25;
  const std::string text = format_document(document);
  const auto again = parse_document(text, "session");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->dust, 0.25);
  EXPECT_EQ(*again, document) << "and so it has a step of the history";

  nlohmann::json older = nlohmann::json::parse(text);
  ASSERT_EQ(older.at("version"), 8);
  ASSERT_EQ(older.erase("dust"), 1U);
  older["version"] = 7;
  const auto read = parse_document(older.dump(), "session");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->dust, 0.0);
}

}  // namespace
}  // namespace dubsar::app
