// A drawer, a tool and a language that the program does not have, built from the files that each touches: no more than
// docs/architecture.md lists, and they work.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "app/panels/panel_font.h"
#include "app/panels/window_panels.h"
#include "app/words/language.h"
#include "tests/app/commands/bench.h"
#include "tests/app/words/drawn_text.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// The list "- **a drawer** ..." of "To add ..." in docs/architecture.md.
std::string list_of(const std::string& thing) {
  std::ifstream file(fs::path(DUBSAR_SOURCE_DIR) / "docs" / "architecture.md");
  std::ostringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  const std::size_t from = text.find("- **" + thing + "**");
  if (from == std::string::npos) return {};
  return text.substr(from, text.find("\n- **", from + 1) - from);
}

TEST(BuiltAdditions, TouchTheFilesThatTheDocumentsListAndNoMore) {
  const std::map<std::string, std::pair<std::string, std::size_t>> most{{"drawer", {"a drawer", 4}},
                                                                        {"tool", {"a tool", 4}},
                                                                        {"language", {"a language", 1}},
                                                                        {"field", {"a field of sessions", 2}}};
  for (const auto& [folder, row] : most) {
    const auto& [thing, files] = row;
    const std::string list = list_of(thing);
    ASSERT_FALSE(list.empty()) << thing;
    std::size_t touched = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(DUBSAR_ADDITIONS) / folder)) {
      if (!entry.is_regular_file()) continue;
      ++touched;
      fs::path path = fs::relative(entry.path(), fs::path(DUBSAR_ADDITIONS) / folder);
      const bool there = path.extension() == ".lines";
      if (there) path.replace_extension();
      EXPECT_EQ(fs::exists(fs::path(DUBSAR_SOURCE_DIR) / path), there) << path;
      const std::string named = "](../" + (there ? path : path.parent_path()).generic_string() + ")";
      EXPECT_NE(list.find(named), std::string::npos) << thing << " touches " << path << ", which is not in: " << list;
    }
    EXPECT_LE(touched, files) << thing;
    EXPECT_GT(touched, 0U) << thing;
  }
}

std::string drawn(const PanelState& state, const KeyTable& keys) {
  for (int pass = 0; pass < 3; ++pass) {
    ImGui::NewFrame();
    std::vector<std::string> said;
    draw_panels(state, keys, 1600.0f, 900.0f, said);
    ImGui::Render();
  }
  std::string out;
  for (const DrawnLetter& letter : drawn_letters()) add_utf8(out, letter.code);
  return out;
}

TEST(BuiltAdditions, ADrawerIsOpenedByItsKeyAndDrawnInBothLanguages) {
  Bench bench;
  const KeyTable keys = KeyTable::create(bench.commands).value();
  bench.run("drawer breaks");
  EXPECT_EQ(bench.editor.ui().drawer, "breaks");
  EXPECT_EQ(keys.keys_for("drawer breaks").size(), 1U);
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = ImVec2(1600.0f, 900.0f);
  for (const float size : {15.0f, kLargeFontPx}) add_panel_font(*io.Fonts, size, panel_letters());
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  PanelState state;
  state.ui.panels = state.files.has_surface = true;
  state.ui.drawer = "breaks";
  EXPECT_NE(drawn(state, keys).find("Nobreakwasfound."), std::string::npos) << "letters, spaces are none";
  ASSERT_TRUE(use_language("de"));
  const std::string german = drawn(state, keys);
  EXPECT_NE(german.find("KeinBruchgefunden."), std::string::npos) << german;
  EXPECT_NE(german.find("Br\u00fcche"), std::string::npos) << german;
  ImGui::DestroyContext();
}

TEST(BuiltAdditions, AToolTakesItsPlacesAndSaysWhatItFound) {
  Bench bench;
  bench.run("tool middle");
  EXPECT_EQ(bench.place.said, "Click two places: their middle.");
  bench.run("point 1,2,5");
  bench.run("point 3,6,5");
  EXPECT_EQ(bench.place.said, "middle at 2, 4");
  EXPECT_TRUE(bench.editor.ui().pending.empty());
  bench.run("point 1,2,5");
  ASSERT_TRUE(use_language("de"));
  bench.run("point 3,2,5");
  EXPECT_EQ(bench.place.said, "Mitte bei 2, 2");
}

TEST(BuiltAdditions, ALanguageIsItsFile) {
  ASSERT_TRUE(use_language("ga"));
  EXPECT_EQ(tr_name("panel", "notes"), "N\u00f3ta\u00ed");
  EXPECT_EQ(tr_name("panel", "film"), "Film") << "what it lacks is English";
  ASSERT_TRUE(use_language("en"));
}

}  // namespace
}  // namespace dubsar::app
