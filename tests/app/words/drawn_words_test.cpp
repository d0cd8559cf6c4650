// Every page and drawer of the window in a language that was made up: what is drawn comes from the table of texts, or
// is a name or a figure; all of it is there, and nothing lies over something else.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>

#include "app/commands/drawers.h"
#include "app/panels/help_page.h"
#include "app/panels/legend_page.h"
#include "app/panels/overlay.h"
#include "app/panels/panel_font.h"
#include "app/panels/state_page.h"
#include "app/panels/window_panels.h"
#include "app/words/language.h"
#include "core/base/files/atomic_file.h"
#include "display/render/shading.h"
#include "tests/app/words/drawn_text.h"
#include "tests/app/words/made_up_language.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// All names are QXZ.
PanelState full_window() {
  PanelState out;
  out.line = {.title = "QXZ.exa", .display = "QXZ", .language = "zz", .side = "obverse", .undo = "a", .redo = "b"};
  Document& document = out.document;
  document.parts = {{"tablet", 1}, {"envelope", 6}};
  document.style.name = "relief";
  document.style.other = "raking";
  document.style.share = 0.3;
  for (const MeasureKind kind :
       {MeasureKind::kDistance, MeasureKind::kAngle, MeasureKind::kDepth, MeasureKind::kProfile}) {
    Measure measure;
    measure.kind = kind;
    measure.name = "QXZ";
    measure.figures.straight_mm = 12.3;
    measure.figures.surface_mm = 13.1;
    measure.figures.depth_mm = 0.4;
    document.measures.push_back(measure);
  }
  Note note;
  note.label = "QXZ";
  note.text = "[QXZ";
  note.line_mm = {{0, 0, 0}, {9, 0, 0}};
  document.notes = {note, note};
  out.ui.note = 1;
  for (int i = 0; i < 3; ++i) document.keyframes.emplace_back().time_s = 2.0 * i;
  document.clips.push_back({});
  out.thumbnails = {11, 12, 13};
  out.evidence = {812.0, 12.5};
  out.mm_per_px = 0.1;
  out.slices.value = 0.25f;
  for (SlicePane& pane : out.slices.panes) pane.wanted.width = pane.wanted.height = 200;
  out.files.has_surface = true;
  out.files.names = {"QXZ.exa", "QXZ.ply"};
  out.ui.panels = true;
  return out;
}

class DrawnWords : public ::testing::Test {
 protected:
  DrawnWords()
      : styles_(names_of_styles()),
        commands_(CommandTable::standard(styles_)),
        keys_(KeyTable::create(commands_).value()) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    for (const float size : {15.0f, kLargeFontPx}) add_panel_font(*io.Fonts, size, panel_letters());
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  ~DrawnWords() override {
    ImGui::DestroyContext();
    EXPECT_TRUE(use_language("en"));
  }
  static std::vector<std::string> names_of_styles() {
    std::vector<std::string> out;
    for (const std::string_view name : shading_preset_names()) out.emplace_back(name);
    return out;
  }
  void speak_made_up() {
    const fs::path file = fs::path(::testing::TempDir()) / "zz.json";
    ASSERT_TRUE(write_file_atomically(file, made_up_file()));
    const auto done = use_language(file.string());
    ASSERT_TRUE(done) << done.error().message;
  }
  template <class Draw>
  std::vector<DrawnLetter> letters(float width, float height, Draw draw) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(width, height);
    io.DeltaTime = 1.0f / 60.0f;
    for (int pass = 0; pass < 3; ++pass) {
      ImGui::NewFrame();
      draw(width, height);
      ImGui::Render();
    }
    return drawn_letters();
  }
  std::vector<DrawnLetter> panels(const PanelState& state, float width, float height) {
    return letters(width, height, [&](float w, float h) {
      std::vector<std::string> said;
      draw_panels(state, keys_, w, h, said);
    });
  }
  /// What is no text of the table, without names, units and figures; and what of the table is cut.
  static void check(const std::vector<DrawnLetter>& letters, const std::string& page, float width) {
    ASSERT_GT(letters.size(), 50U) << page;
    std::string outside, text;
    int depth = 0, list = -1;
    for (const DrawnLetter& letter : letters) {
      if (letter.list != list) {
        EXPECT_EQ(depth, 0) << page << ": " << text << " is not drawn to its end";
        depth = 0;
        list = letter.list;
      }
      EXPECT_TRUE(letter.inside && letter.from.x >= -1.0f && letter.to.x <= width + 1.0f)
          << page << ": cut in " << text << " at " << letter.from.x << ", " << letter.from.y;
      if (letter.code == 0xab && depth++ == 0) text.clear();
      add_utf8(depth > 0 ? text : outside, letter.code);
      if (letter.code == 0xbb) {
        EXPECT_GT(depth, 0) << page << ": a text without its beginning before " << text;
        depth = std::max(0, depth - 1);
      }
    }
    EXPECT_EQ(depth, 0) << page << ": " << text << " is not drawn to its end";
    const std::regex data(R"(QXZ|exa|ply|mm(?:²)?|min|ms|kB|MB|zz|F[0-9]+|MSII|[xyzsABCDEFGHIJKLMNOPQRSTUVWXYZ])");
    const std::string rest = std::regex_replace(outside, data, "");
    EXPECT_FALSE(std::any_of(rest.begin(), rest.end(), [](char c) { return c >= 'a' && c <= 'z'; }))
        << page << " draws what is not in app/words/en.json: " << rest;
    for (const std::string& both : overlapping(letters)) ADD_FAILURE() << page << ": one over the other: " << both;
  }
  std::vector<std::string> styles_;
  CommandTable commands_;
  KeyTable keys_;
};

/// Closed, and each of them open.
std::vector<std::string> drawers() {
  std::vector<std::string> out{""};
  for (const DrawerRow& row : kDrawers) out.emplace_back(row.name);
  return out;
}

TEST_F(DrawnWords, EveryDrawerSpeaksTheLanguageAndHasRoomForIt) {
  speak_made_up();
  PanelState state = full_window();
  for (const std::string& drawer : drawers()) {
    state.ui.drawer = drawer;
    check(panels(state, 1600.0f, 900.0f), "drawer " + drawer, 1600.0f);
  }
}

TEST_F(DrawnWords, EmptyDrawersSayWhatToDo) {
  speak_made_up();
  PanelState state = full_window();
  state.document.measures.clear();
  state.document.notes.clear();
  state.document.keyframes.clear();
  for (const char* const drawer : {"measures", "notes", "film"}) {
    state.ui.drawer = drawer;
    check(panels(state, 1600.0f, 900.0f), std::string("empty drawer ") + drawer, 1600.0f);
  }
}

TEST_F(DrawnWords, FilesAndCommandsAreAskedForInTheLanguage) {
  speak_made_up();
  PanelState state = full_window();
  state.ui.panels = false;
  state.ui.choosing.open = true;
  state.files.recent = {{"/QXZ/QXZ.exa", true}, {"/QXZ/QXZ.ply", false}};
  state.files.listing = FolderListing{"/QXZ", {{"QXZ", true, 0}, {"QXZ.exa", false, 2'901'985}}, {}};
  check(panels(state, 1600.0f, 900.0f), "open dialogue", 1600.0f);
  state.files.listing->entries.clear();
  state.files.opening = JobState{"QXZ.exa", 0.4, 100.0};
  check(panels(state, 1600.0f, 900.0f), "empty folder, and a file that is read", 1600.0f);
  state.ui.choosing.open = false;
  state.files.opening.reset();
  state.ui.palette = true;
  check(panels(state, 1600.0f, 900.0f), "palette", 1600.0f);
}

TEST_F(DrawnWords, TheHelpSpeaksTheLanguage) {
  speak_made_up();
  StateFigures figures;
  figures.display = "QXZ";
  figures.sources = {{"QXZ", SourceHealth::kPresent, {}}, {"QXZ", SourceHealth::kMissing, "QXZ"}};
  std::vector<HelpSection> help = state_page(figures);
  for (HelpSection& section :
       help_page(default_mapping().value(), keys_, {.more = true, .two_eyes = true, .touch = true}))
    help.push_back(std::move(section));
  HelpScroll scroll;
  check(letters(1600.0f, 900.0f, [&](float w, float h) { draw_help(help, w, h, 0.0f, scroll); }), "help", 1600.0f);
}

TEST_F(DrawnWords, LegendsSpeakTheLanguage) {
  speak_made_up();
  Style style;
  style.map = ColorMap::kMean;
  const LegendPicture legend = legend_of(style).value();
  EXPECT_TRUE(legend.name.starts_with("\u00ab"));
}

// What people have: German, in a window as it opens and in the smallest layout, without anything cut or covered.
TEST_F(DrawnWords, GermanAndEnglishFitTheSmallestWindow) {
  for (const std::string language : {"en", "de"}) {
    ASSERT_TRUE(use_language(language));
    PanelState state = full_window();
    for (const auto& [width, height] : {std::pair{1280.0f, 720.0f}, std::pair{960.0f, 540.0f}})
      for (const std::string& drawer : drawers()) {
        state.ui.drawer = drawer;
        const auto drawn = panels(state, width, height);
        const std::string page = language + fmt::format(" at {} drawer ", width) + drawer;
        for (const std::string& both : overlapping(drawn)) ADD_FAILURE() << page << ": one over the other: " << both;
        for (const DrawnLetter& letter : drawn)
          EXPECT_TRUE(letter.inside && letter.to.x <= width + 1.0f)
              << page << ": cut at " << letter.from.x << ", " << letter.from.y;
      }
  }
}

}  // namespace
}  // namespace dubsar::app
