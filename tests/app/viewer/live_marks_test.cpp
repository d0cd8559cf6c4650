// Measures, notes and commands in a window, by mouse, keys and scripts.

#include <fstream>
#include <regex>
#include <set>

#include "app/commands/sides.h"
#include "core/base/files/atomic_file.h"
#include "tests/app/viewer/live_fixture.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

void click(testing::XPerson& person, int x, int y) {
  person.point(kX + x, kY + y);
  person.press(1);
  person.release(1);
  person.settle();
}

TEST_F(Live, ClicksWithAToolMeasureAndDragsStillTurn) {
  const auto measures = [](std::size_t count) {
    return [count](const ViewMoment& m) { return m.viewer.document().measures.size() == count; };
  };
  Image before, after;
  const auto done = play({
      look(before),
      {[] { person_->key("d"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "distance"; }},
      {[] { click(*person_, 100, 120); }, [](const ViewMoment& m) { return m.viewer.ui().pending.size() == 1; }},
      {[] { click(*person_, 220, 120); }, measures(1)},
      look(after),
      {[] {
         person_->point(kX + 100, kY + 100);
         person_->press(1);
         for (int i = 1; i <= 50; ++i) person_->point(kX + 100 + i, kY + 100);
         person_->release(1);
       },
       [](const ViewMoment& m) {
         return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) > 5;
       }},
      {[] {  // keys and clicks come in the order in which they were made
         person_->key("v");
         person_->key("n");
         click(*person_, 150, 110);
       },
       [](const ViewMoment& m) { return m.viewer.document().notes.size() == 1; }},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "turn"; }},
      {[] {  // also where all of them come during one picture, and no tool was in the hand before
         person_->key("d");
         click(*person_, 100, 120);
         click(*person_, 160, 120);
       },
       measures(2)},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "turn"; }},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().leaving; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(done->document.measures.size(), 2u);
  // 120 of 240 pixels of the window's height; the box is 40 mm wide and fits with a margin of 8 % on each side. Its
  // front is nearer to the eye than its middle by 1 %.
  const double mm_per_px = 40.0 / (240 * 0.84);
  EXPECT_NEAR(done->document.measures[0].figures.straight_mm, 0.99 * 120 * mm_per_px, 0.15);
  EXPECT_EQ(done->document.notes[0].label, "o. 1");
  EXPECT_GT(differing_share(before, after), 0.002) << "the measure is seen";
}

TEST_F(Live, WhatIsTypedAfterANoteWasPinnedIsItsTextAndEscapeKeepsIt) {
  options_.around.panels = true;
  options_.window->width = 800;
  options_.window->height = 600;
  const auto text = [](std::string words) {
    return [words](const ViewMoment& m) {
      return m.viewer.document().notes.size() == 1 && m.viewer.document().notes[0].text == words;
    };
  };
  const auto done = play({
      {[] { person_->key("n"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "note"; }},
      {[] {
         click(*person_, 400, 300);
         person_->key("s");  // at once
       },
       text("s")},
      {[] {
         for (const char* letter : {"i", "d", "e", "space", "3"}) person_->key(letter);
       },
       text("side 3")},
      {[] { person_->key("escape"); }, text("side 3")},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "turn"; }},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().drawer.empty(); }},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().leaving; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(done->document.notes.size(), 1u);
  EXPECT_EQ(done->document.notes[0].text, "side 3");
  EXPECT_EQ(done->document.style, Document().style) << "s, i and d were typed, not pressed";
}

TEST_F(Live, WordsAreTypedIntoThePaletteAndKeysDoNothingElseMeanwhile) {
  options_.around.panels = true;
  options_.window->width = 800;
  options_.window->height = 600;
  const auto done = play({
      {[] {
         person_->hold("control");
         person_->key("k");
         person_->let_go("control");
         person_->key("s");  // at once
       },
       [](const ViewMoment& m) { return m.viewer.ui().palette; }},
      {[] {
         for (const char* letter : {"i", "d", "e", "space", "r", "e", "v"}) person_->key(letter);
         person_->key("enter");
       },
       [](const ViewMoment& m) {
         return !m.viewer.ui().palette && facing_side(m.report.view.rotation) == Side::kReverse && !m.report.moving;
       }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->document.style, Document().style) << "s, i and d were typed, not pressed";
}

TEST_F(Live, AScriptSaysEveryCommandThereIs) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_every_{}", ::getpid());
  fs::create_directories(folder);
  const std::string text =
      std::regex_replace(read_text_file(DUBSAR_EVERY_COMMAND).value(), std::regex("FOLDER"), folder.string());
  options_.steps = parse_steps(text, "every_command.txt").value();
  options_.time.longest_s = 60;
  options_.displays = {{"anaglyph"}};
  std::set<std::string> said;
  for (const TimedCommand& step : options_.steps) said.emplace(split_command(step.text).first);
  std::vector<std::string> styles;
  for (const std::string_view name : shading_preset_names()) styles.emplace_back(name);
  const CommandTable table = CommandTable::standard(styles);
  for (const Command& command : table.all()) EXPECT_TRUE(said.contains(command.name)) << command.name;
  TriMesh mesh = testing::sphere(20.0f, 120, 240);  // flattened; one half is the envelope
  for (glm::vec3& p : mesh.positions) p.z *= 0.3f;
  mesh.normals.clear();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.triangle_partition.push_back(2 * t < mesh.triangles.size() ? 0 : 1);
  mesh.partitions = {{.id = 0, .name = "tablet"}, {.id = 1, .name = "envelope"}};
  for (const char* name : {"a.ply", "b.ply"}) std::ofstream(folder / name) << name;
  const auto read = [&](const fs::path& path, Progress&, const TellCoarse&) -> Result<OpenedSurface> {
    OpenedSurface out{mesh, {}, {}, path.filename().string()};
    out.work.surface = path;
    return out;
  };
  FileLoader loader(read, folder / "recent.json");
  ASSERT_TRUE(loader.open({folder / "a.ply"}));
  SilentProgress silent;
  const auto done = run_view(TriMesh(), options_, silent, {}, &loader);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(loader.files().size(), 2u);
  EXPECT_LT(done->seconds, 40.0) << "its last command ends the session";
  EXPECT_EQ(done->document.measures.size(), 4u);
  EXPECT_EQ(done->document.notes.size(), 2u);
  EXPECT_EQ(done->document.notes[0].text, "q\u00ed-bi\u2084-ma");
  EXPECT_GT(done->document.notes[1].line_mm.size(), 20u) << "the line follows the surface";
  EXPECT_EQ(done->document.keyframes.size(), 1u);
  for (const char* name :
       {"measures.json", "notes.json", "notes.jsonld", "film.json", "seen.png", "seen.tif", "slice.png"})
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  fs::remove_all(folder);
}

TEST_F(Live, AStepThatCannotBeDoneEndsTheSessionAndSaysWhen) {
  options_.steps = {{0.1, "side reverse"}, {0.2, "delete_note 3"}};
  SilentProgress silent;
  const auto done = run_view(testing::lettered_box(), options_, silent);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "at 0.2 s: delete_note: there is nothing to do it to now");
  options_.steps = {{0.1, "dance"}};
  EXPECT_EQ(run_view(testing::lettered_box(), options_, silent).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar::app
