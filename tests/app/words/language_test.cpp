// The table of texts and its translations.

#include "app/words/language.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "app/kiosk/operator_menu.h"
#include "app/words/language_files.h"
#include "core/base/files/atomic_file.h"
#include "display/render/mesh/surface_field.h"
#include "display/render/shading.h"
#include "tests/app/commands/bench.h"
#include "tests/app/words/made_up_language.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

class WindowLanguage : public ::testing::Test {
 protected:
  ~WindowLanguage() override { EXPECT_TRUE(use_language("en")); }
};

Language of(const std::string& json) { return Language::parse("xx", json, "xx.json").value(); }
std::string refusal(const std::string& json) {
  const auto made = Language::parse("xx", json, "xx.json");
  return made ? "taken" : made.error().message;
}

TEST_F(WindowLanguage, EveryIdIsThereOnce) {
  std::set<std::string_view> ids;
  for (const TextRow& row : kEnglish) {
    EXPECT_TRUE(ids.insert(row.id).second) << row.id;
    EXPECT_FALSE(row.text.empty()) << row.id;
    EXPECT_EQ(Text::find(row.id).english(), row.text);
  }
  EXPECT_TRUE(Text::find("tool.trun").empty());
}

TEST_F(WindowLanguage, EveryLanguageOfTheProgramHasEveryText) {
  ASSERT_FALSE(language_files().empty());
  for (const auto& [name, text] : language_files()) {
    const auto made = Language::parse("xx", text, name);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->translated(), kEnglish.size()) << name << " lacks some";
    int same = 0;
    for (const TextRow& row : kEnglish) same += (*made)[Text::find(row.id)] == row.text;
    EXPECT_LT(same, static_cast<int>(kEnglish.size() / 10)) << name << " is English to a good part";
  }
}

TEST_F(WindowLanguage, PlacesInBracesAreThoseOfTheEnglishText) {
  EXPECT_EQ(refusal(R"({"files.position": "{1}: {0}"})"), "taken");
  EXPECT_NE(refusal(R"({"files.position": "{0}"})").find("files.position"), std::string::npos);
  EXPECT_NE(refusal(R"({"files.position": "{0} {1} {2}"})").find("the same places"), std::string::npos);
  EXPECT_NE(refusal(R"({"tool.trun": "a"})").find("tool.trun"), std::string::npos);
  EXPECT_NE(refusal(R"({"tool.turn": 3})"), "taken");
  EXPECT_NE(refusal(R"({"tool.turn": ""})"), "taken");
  EXPECT_NE(refusal(R"(["tool.turn"])"), "taken");
  EXPECT_NE(refusal(R"({"tool.turn": "a|b"})"), "taken") << "it counts nothing";
  EXPECT_NE(refusal(R"({"marks.notes": "{0} notes"})"), "taken") << "two forms";
}

/// Rules as CLDR has them: German and English 1 and others; French 0 and 1; Polish and Russian three for whole numbers
/// but 1, that differ there; Japanese none.
TEST_F(WindowLanguage, CountsAsTheLanguageDoes) {
  const Language russian = of(R"({"language.plural": "slavic", "marks.notes": "{0} заметка|{0} заметки|{0} заметок"})");
  const std::map<long long, std::size_t> forms{{1, 0}, {21, 0}, {101, 0}, {2, 1},  {4, 1},   {22, 1},
                                               {5, 2}, {11, 2}, {12, 2},  {14, 2}, {111, 2}, {0, 2}};
  for (const auto& [count, form] : forms) EXPECT_EQ(russian.form(count), form) << count;
  EXPECT_EQ(of(R"({"language.plural": "zero-one"})").form(0), 0U);
  EXPECT_EQ(Language().form(0), 1U);
  EXPECT_EQ(of(R"({"language.plural": "none", "marks.notes": "{0}"})").form(1), 0U);
  EXPECT_EQ(tr("marks.notes", 1), "1 note");
  EXPECT_EQ(tr("marks.notes", 12), "12 notes");
  ASSERT_TRUE(use_language("de"));
  EXPECT_EQ(tr("marks.notes", 1), "1 Notiz");
  EXPECT_EQ(tr("marks.measures", 0), "0 Maße");
}

TEST_F(WindowLanguage, FiguresAreWrittenAsInTheLanguage) {
  EXPECT_EQ(local_figures("12.35 mm, 0.5 %. End"), "12.35 mm, 0.5 %. End");
  ASSERT_TRUE(use_language("de"));
  EXPECT_EQ(local_figures("12.35 mm, 0.5 %. End"), "12,35 mm, 0,5 %. End");
  EXPECT_EQ(tr("files.position", 2, 7), "2 von 7");
  EXPECT_EQ(tr_name("side", "obverse"), "Vorderseite");
  EXPECT_EQ(tr_name("part", "fragment 7"), "fragment 7") << "a name is data";
}

TEST_F(WindowLanguage, IsAskedForByCodeByFileOrByTheDesktop) {
  EXPECT_EQ(language_of_locale("de_AT.UTF-8"), "de");
  EXPECT_EQ(language_of_locale("de"), "de");
  EXPECT_EQ(language_of_locale("C"), "en");
  EXPECT_EQ(language_of_locale("tlh_XX@q"), "en");
  const auto refused = use_language("tlh");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("de"), std::string::npos) << "says which there are";
  EXPECT_EQ(language().code(), "en") << "as it was";
}

// One file in the test's own folder is all that a third language takes.
TEST_F(WindowLanguage, AThirdOneIsOneFile) {
  const fs::path file = fs::path(::testing::TempDir()) / "zz.json";
  ASSERT_TRUE(write_file_atomically(file, made_up_file()));
  const auto done = use_language(file.string());
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(language().code(), "zz");
  for (const TextRow& row : kEnglish)
    if (!row.id.starts_with("language.")) {
      const std::string& text = text_of(Text::find(row.id));
      EXPECT_TRUE(text.starts_with("\u00ab") && text.ends_with("\u00bb")) << row.id;
    }
}

TEST_F(WindowLanguage, WhatPeopleReadByNamesHasTexts) {
  std::vector<std::string> styles;
  for (const std::string_view name : shading_preset_names()) styles.emplace_back(name);
  const CommandTable commands = CommandTable::standard(styles);
  std::set<std::string> used;
  for (const Command& command : commands.all()) {
    EXPECT_FALSE(command.words.empty()) << command.name;
    used.insert("command." + command.name);
    const bool named = command.closed && command.name != "toggle_source" && command.name != "slice_large";
    if (named) {
      for (const std::string& value : command.values)
        EXPECT_FALSE(Text::find(std::string(command.argument.id().substr(4)) + "." + value).empty())
            << command.name << " " << value;
    }
  }
  for (const TextRow& row : kEnglish) {
    const bool of_calibration = row.id.starts_with("command.p") || row.id.starts_with("command.slope");
    EXPECT_TRUE(!row.id.starts_with("command.") || used.contains(std::string(row.id)) || of_calibration)
        << row.id << " is a command no more";
  }
  for (const std::string& style : styles) EXPECT_FALSE(Text::find("style." + style).empty()) << style;
  ASSERT_TRUE(use_language("de"));
  for (const OperatorRow& row : OperatorMenu::rows()) EXPECT_NE(tr_name("operator", row.words), row.words);
  for (const ColorMap map : {ColorMap::kIntegral, ColorMap::kMean, ColorMap::kGaussian, ColorMap::kShapeIndex,
                             ColorMap::kCurvedness, ColorMap::kDifference}) {
    Style style;
    style.map = map;
    const std::string name(field_scale(style).name);
    EXPECT_NE(tr_name("legend", name), name);
  }
}

// Said over the picture, by any command.
TEST_F(WindowLanguage, WhatCommandsSayComesFromTheTable) {
  const fs::path file = fs::path(::testing::TempDir()) / "zz.json";
  ASSERT_TRUE(write_file_atomically(file, made_up_file()));
  Bench bench;
  int said = 0;
  for (const std::string& text : ways_to_say(bench.commands)) {
    ASSERT_TRUE(use_language(file.string()));
    bench.place.said.clear();
    static_cast<void>(bench.commands.run(text, bench.editor));
    const bool figures = bench.place.said == "5.000 mm" || bench.place.said == "0.00\u00b0";
    if (bench.place.said.empty() || figures || text.starts_with("ui_language")) continue;
    ++said;
    EXPECT_NE(bench.place.said.find("\u00ab"), std::string::npos) << text << " says " << bench.place.said;
  }
  EXPECT_GT(said, 10);
}

// Dead texts cost every translator time.
TEST_F(WindowLanguage, EveryTextIsUsed) {
  std::string sources;
  for (const auto& entry : fs::recursive_directory_iterator(DUBSAR_APP_SOURCES))
    if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h")
      sources += read_text_file(entry.path()).value();
  std::set<std::string> families;
  const std::regex by_name(R"re((?:tr_name|find)\("([a-z_]+)[".])re");
  for (std::sregex_iterator at(sources.begin(), sources.end(), by_name), end; at != end; ++at)
    families.insert((*at)[1]);
  for (const std::string family : {"way", "back_faces", "beside"}) families.insert(family);  // arguments of commands
  for (const TextRow& row : kEnglish) {
    const std::string family(row.id.substr(0, row.id.find('.')));
    const bool used = sources.find("\"" + std::string(row.id) + "\"") != std::string::npos;
    EXPECT_TRUE(used || families.contains(family)) << row.id << " is used nowhere";
  }
}

}  // namespace
}  // namespace dubsar::app
