// The page of help says what keys and mouse do, and nothing else.

#include "app/panels/help_page.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/panels/palette.h"

namespace dubsar::app {
namespace {

/// The heading under which a row's command stands.
std::string_view find_group(const CommandTable& commands, const std::string& text) {
  const Command* const command = commands.find(split_command(text).first);
  return command == nullptr ? std::string_view() : command->group.english();
}

TEST(HelpPage, SaysKeysAsPeopleDo) {
  const CommandTable commands = CommandTable::standard({"relief"});
  const KeyTable keys = KeyTable::create(commands).value();
  int seen = 0;
  for (const HelpSection& section : help_page(default_mapping().value(), keys))
    for (const HelpRow& row : section.rows) {
      EXPECT_EQ(row.what.find('_'), std::string::npos) << row.what;
      seen += row.what.find("Page Up") != std::string::npos;
    }
  EXPECT_GE(seen, 2) << "roll_left, previous_file";
  EXPECT_EQ(key_words("ctrl+page_up"), "Ctrl+Page Up");
  EXPECT_EQ(key_words("ctrl++"), "Ctrl++");
  EXPECT_EQ(key_words("+"), "+");
  EXPECT_EQ(key_words("shift+n"), "Shift+N");
  EXPECT_EQ(key_words("f12"), "F12");
  EXPECT_EQ(key_words("\u0161"), "\u0161");
}

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
  EXPECT_EQ(find(page, "Back", "Backspace  Ctrl+Z"), "undo");
  EXPECT_EQ(find(page, "This window", "P  L  T  M  Shift+N  Shift+G  C  Shift+S  Shift+K  Shift+E  Shift+F"), "panel")
      << "a list of more than 72 letters is for the palette";
  EXPECT_EQ(find(page, "Light", "Alt+1 to Alt+8"), "raking light from one of eight directions");
  EXPECT_EQ(find(page, "Measures", "V  D  A  W  F  N  I  J  Shift+W  Shift+A  Shift+M"), "what a click does")
      << "a list of more than 72 letters is for the palette";
  EXPECT_EQ(find(page, "Sides", "1 to 6"), "turn to a side: obverse, bottom, reverse, top, left, right");
  EXPECT_EQ(find(page, "Hands", "pinch and move"), "move the light");
  EXPECT_EQ(find(page, "Hands", "grab and pull"), "zoom");
  EXPECT_EQ(find(page, "This window", "F1  ?"), "this help");
  const auto plain = help_page(default_mapping().value(), keys, {.more = false, .two_eyes = false});
  EXPECT_EQ(find(plain, "Hands", "grab and pull"), "") << "no device follows hands";
  EXPECT_EQ(find(plain, "3D mouse", "push"), "");
  EXPECT_EQ(find(plain, "View", "Home"), "back to the first view") << "without the button of a puck";
  EXPECT_EQ(find(plain, "This window", "X"), "") << "one view has no eyes to exchange";
  EXPECT_EQ(find(plain, "Mouse", "left drag"), "turn");
  EXPECT_EQ(find(plain, "Touch", "a finger"), "");
  const auto touch = help_page(default_mapping().value(), keys, {.more = false, .two_eyes = false, .touch = true});
  EXPECT_EQ(find(touch, "Touch", "a finger"), "turn");
  EXPECT_EQ(find(touch, "Touch", "two fingers"), "zoom, move and roll");
  const auto museum =
      help_page(parse_mapping(R"({"hands": {"pinch": "none"}, "mouse": {"alt+left": "light", "wheel": null},
      "priority": ["hands", "mouse"]})",
                              "museum")
                    .value(),
                keys);
  EXPECT_EQ(find(museum, "Mouse", "alt+left drag"), "move the light");
  EXPECT_EQ(find(museum, "Mouse", "wheel"), "");
  EXPECT_EQ(find(museum, "Hands", "pinch and move"), "");
  EXPECT_EQ(find(museum, "Back", "Backspace  Ctrl+Z"), "") << "the keyboard does not steer";
}

TEST(Palette, FindsCommandsByTheirWordsAndSaysTheirKeys) {
  const CommandTable commands = CommandTable::standard({"relief", "raking"});
  const KeyTable keys = KeyTable::create(commands).value();
  const auto first = [&](std::string_view typed) {
    const auto rows = palette_rows(keys, typed, 12);
    return rows.empty() ? PaletteRow() : rows[0];
  };
  EXPECT_EQ(first("rev").text, "side reverse");
  EXPECT_EQ(first("rev").key, "3");
  EXPECT_EQ(first("style rak").text, "style raking");
  EXPECT_EQ(first("WEDGE depth").text, "measure_depth");
  EXPECT_FALSE(first("measure_depth").ready) << "its place has to be told";
  EXPECT_EQ(first("measure_depth 1,2,3").text, "measure_depth 1,2,3") << "as it was typed";
  EXPECT_EQ(first("unpack 37").text, "unpack 37");
  EXPECT_TRUE(palette_rows(keys, "xyzzy", 12).empty());
  EXPECT_EQ(palette_rows(keys, "", 12).size(), 12u);
  EXPECT_NE(find_group(commands, palette_rows(keys, "", 12)[0].text), kWindowGroup.english())
      << "what is done to the object";
  std::size_t found = 0;  // nothing is left out
  for (const Command& command : commands.all()) {
    if (command.name == "palette") continue;
    const auto rows = palette_rows(keys, command.name, 100);
    found += std::any_of(rows.begin(), rows.end(),
                         [&](const PaletteRow& row) { return split_command(row.text).first == command.name; });
  }
  EXPECT_EQ(found, commands.all().size() - 1);
}

}  // namespace
}  // namespace dubsar::app
