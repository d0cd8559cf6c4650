// The page of help says what keys and mouse do, and nothing else.

#include "app/panels/help_page.h"

#include <gtest/gtest.h>

namespace dubsar::app {
namespace {

TEST(HelpPage, SaysWhatTheMappingSays) {
  const auto find = [](const std::vector<HelpSection>& page, std::string_view title,
                       std::string_view what) -> std::string {
    for (const HelpSection& section : page)
      if (section.title == title)
        for (const HelpRow& row : section.rows)
          if (row.what == what) return row.does;
    return {};
  };
  const CommandTable commands = CommandTable::standard({"relief"});
  const KeyTable keys = KeyTable::create(commands).value();
  const auto page = help_page(default_mapping().value(), keys);
  EXPECT_EQ(find(page, "Mouse", "left drag"), "turn");
  EXPECT_EQ(find(page, "Mouse", "shift+left drag"), "move");
  EXPECT_EQ(find(page, "Mouse", "wheel"), "zoom");
  EXPECT_EQ(find(page, "Back", "backspace ctrl+z"), "undo");
  EXPECT_EQ(find(page, "This window", "p l t"), "panel: parts, light, style");
  EXPECT_EQ(find(page, "Sides", "1 to 6"), "turn to a side: obverse, bottom, reverse, top, left, right");
  EXPECT_EQ(find(page, "Hands", "pinch and move"), "move the light");
  EXPECT_EQ(find(page, "This window", "f1 ?"), "this help");
  const auto museum =
      help_page(parse_mapping(R"({"hands": {"pinch": "none"}, "mouse": {"alt+left": "light", "wheel": null},
      "priority": ["hands", "mouse"]})",
                              "museum")
                    .value(),
                keys);
  EXPECT_EQ(find(museum, "Mouse", "alt+left drag"), "move the light");
  EXPECT_EQ(find(museum, "Mouse", "wheel"), "");
  EXPECT_EQ(find(museum, "Hands", "pinch and move"), "");
  EXPECT_EQ(find(museum, "Back", "backspace ctrl+z"), "") << "the keyboard does not steer";
}

}  // namespace
}  // namespace dubsar::app
