// Measures, notes, cuts and films by commands, without a window.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/document/mark_file.h"
#include "core/base/files/atomic_file.h"
#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

TEST(MarkCommands, ClicksWithAToolMakeAMeasureAsSoonAsThereAreEnough) {
  Bench bench;
  EXPECT_EQ(bench.refusal("point 1,2,3"), "point: there is nothing to do it to now") << "no tool is taken";
  bench.run("tool distance");
  bench.run("point 0,0,9");
  EXPECT_EQ(bench.now().measures.size(), 0u);
  EXPECT_EQ(bench.editor.ui().pending.size(), 1u);
  bench.run("point 3,4,9");
  ASSERT_EQ(bench.now().measures.size(), 1u);
  const Measure& measure = bench.now().measures[0];
  EXPECT_EQ(measure.points_mm, (std::vector<glm::dvec3>{{0, 0, 5}, {3, 4, 5}})) << "on the surface";
  EXPECT_EQ(measure.figures.straight_mm, 5.0);
  EXPECT_EQ(measure.part, "tablet");
  EXPECT_EQ(bench.place.said, "5.000 mm");
  EXPECT_EQ(bench.editor.ui().tool, "distance") << "the next two clicks measure again";
  EXPECT_EQ(bench.editor.history().undo_depth(), 1u) << "one step";
  bench.run("tool angle");
  for (const char* at : {"1,0,0", "0,0,0", "0,1,0"}) bench.run(std::string("point ") + at);
  EXPECT_EQ(bench.now().measures.back().kind, MeasureKind::kAngle);
  bench.run("tool depth");
  bench.run("point 7,7,7");
  EXPECT_EQ(bench.now().measures.back().kind, MeasureKind::kDepth);
  EXPECT_EQ(bench.refusal("point 99,0,0"), "depth: no surface") << "what cannot be measured says why";
  EXPECT_EQ(bench.now().measures.size(), 3u);
  bench.run("tool depth");
  EXPECT_EQ(bench.editor.ui().tool, "turn") << "said again, it is laid down";
}

TEST(MarkCommands, TheDepthOfAWedgeIsToldWithItsUncertainty) {
  Measure measure;
  measure.kind = MeasureKind::kDepth;
  measure.figures.depth_mm = 0.4123;
  EXPECT_EQ(figures_text(measure), "0.412 mm deep") << "of a session of an earlier version";
  measure.figures.uncertainty_mm = 0.0211;
  EXPECT_EQ(figures_text(measure), "0.412 \u00b1 0.021 mm deep");
  Document document;
  document.measures = {measure};
  EXPECT_NE(format_measures(document).find("\"uncertainty_mm\": 0.0211"), std::string::npos);
}

TEST(MarkCommands, MeasuresAreNamedTakenAwayAndUndone) {
  Bench bench;
  bench.run("measure_profile 0,0,0 10,0,0 the rim");
  bench.run("measure_distance 0,0,0 0,2,0");
  EXPECT_EQ(bench.now().measures[0].name, "the rim");
  bench.run("name_measure 2 \u0161u");
  EXPECT_EQ(bench.now().measures[1].name, "\u0161u");
  bench.run("delete_measure 1");
  ASSERT_EQ(bench.now().measures.size(), 1u);
  EXPECT_EQ(bench.now().measures[0].name, "\u0161u");
  bench.run("undo");
  EXPECT_EQ(bench.now().measures.size(), 2u);
  EXPECT_EQ(bench.refusal("delete_measure 3"), "delete_measure: \"3\" found, expected a number of 1 to 2");
  EXPECT_EQ(bench.refusal("measure_angle 1,2,3 4,5,6"),
            "measure_angle: \"1,2,3 4,5,6\" found, expected 3 places such as 12.5,3,40 (mm)");
  EXPECT_EQ(bench.refusal("measure_depth 1,2,x"),
            "measure_depth: \"x\" found, expected a number of -100000000000 to 100000000000");
}

TEST(MarkCommands, NotesAreNumberedAsEditionsCountAndComeBackAsTheyWereSeen) {
  Bench bench;
  bench.run("add_note 1,2,3 a-na \u1e2ba-x");
  bench.run("side reverse");
  const CameraPose seen = bench.now().now;
  bench.run("add_note -1,0,0");
  bench.run("add_line 1,0,0 9,0,0 um-ma");
  bench.run("tool note");
  bench.run("point 2,2,2");
  ASSERT_EQ(bench.now().notes.size(), 4u);
  EXPECT_EQ(bench.now().notes[0].label, "o. 1");
  EXPECT_EQ(bench.now().notes[0].text, "a-na \u1e2ba-x");
  EXPECT_EQ(bench.now().notes[1].label, "r. 1");
  EXPECT_EQ(bench.now().notes[2].label, "o. 1") << "lines count for themselves";
  EXPECT_EQ(bench.now().notes[2].line_mm.size(), 2u);
  EXPECT_EQ(bench.now().notes[3].label, "o. 2");
  EXPECT_EQ(bench.now().notes[3].created, "2026-11-27");
  EXPECT_EQ(bench.editor.ui().note, 4u) << "the new one is open";
  bench.run("note_text 2 um-ma a-\u0161\u00f9r");
  bench.run("note_label 2 r. 12");
  bench.run("side obverse");
  bench.run("go_to_note 2");
  EXPECT_EQ(bench.now().now, seen);
  EXPECT_EQ(bench.editor.transition(), Transition::kGlide);
  bench.run("delete_note 1");
  EXPECT_EQ(bench.now().notes[0].label, "r. 12");
}

TEST(MarkCommands, FilesSayWhatWasMeasuredAndNotedAndNothingElseIsOverwritten) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_marks_{}", ::getpid());
  fs::create_directories(folder);
  Bench bench;
  bench.run("measure_distance 0,0,0 3,4,0 a b");
  bench.run("measure_depth 1,1,1");
  bench.run("add_note 1,2,3 a-na \u1e2ba-x");
  bench.run("add_line 1,0,0 9,0,0 um-ma");
  const std::string measures = (folder / "m.json").string(), notes = (folder / "n.json").string(),
                    web = (folder / "n.jsonld").string();
  for (int twice = 0; twice < 2; ++twice) {  // its own files are written again
    bench.run("write_measures " + measures);
    bench.run("write_notes " + notes);
    bench.run("write_annotations " + web);
  }
  const json m = json::parse(read_text_file(measures).value());
  EXPECT_EQ(m["format"], "dubsar measures");
  EXPECT_EQ(m["measures"][0]["straight_mm"], 5.0);
  EXPECT_EQ(m["measures"][0]["surface_mm"], nullptr) << "the surface does not lead there";
  EXPECT_EQ(m["measures"][0]["name"], "a b");
  EXPECT_FALSE(m["measures"][1].contains("straight_mm"));
  const json n = json::parse(read_text_file(notes).value());
  EXPECT_EQ(n["notes"][0]["text"], "a-na \u1e2ba-x");
  EXPECT_EQ(n["notes"][1]["line_mm"], json::parse("[[1.0,0.0,5.0],[9.0,0.0,5.0]]"));
  const json w = json::parse(read_text_file(web).value());
  EXPECT_EQ(w["@context"][0], "http://www.w3.org/ns/anno.jsonld");
  EXPECT_EQ(w["type"], "AnnotationCollection");
  EXPECT_EQ(w["total"], 2);
  const json& first = w["first"]["items"][0];
  EXPECT_EQ(first["type"], "Annotation");
  EXPECT_EQ(first["body"]["type"], "TextualBody");
  EXPECT_EQ(first["body"]["value"], "a-na \u1e2ba-x");
  EXPECT_EQ(first["target"]["selector"]["x"], 1.0);
  EXPECT_EQ(w["first"]["items"][1]["target"]["selector"]["value"],
            "LINESTRING Z (1.000 0.000 5.000, 9.000 0.000 5.000)");
  EXPECT_EQ(w["first"]["items"][1]["body"]["language"], "akk-Latn");
  EXPECT_NE(first["id"], w["first"]["items"][1]["id"]);
  const fs::path other = folder / "scan.json";
  std::ofstream(other) << "{\"my\": \"own\"}";
  EXPECT_NE(bench.refusal("write_notes " + other.string()).find("something else is there"), std::string::npos);
  EXPECT_NE(bench.refusal("write_notes " + (folder / "x.exa").string()).find("ends in .json"), std::string::npos);
  fs::create_symlink(other, folder / "link.json");
  EXPECT_NE(bench.refusal("write_notes " + (folder / "link.json").string()), "accepted");
  EXPECT_EQ(read_text_file(other).value(), "{\"my\": \"own\"}");
  fs::remove_all(folder);
}

TEST(MarkCommands, CutsReplaceTheirOwnDirectionMoveAndGo) {
  Bench bench;
  bench.run("cut front 20");
  ASSERT_EQ(bench.now().clips.size(), 1u);
  EXPECT_EQ(bench.now().clips[0].normal, glm::dvec3(0, 0, 1));
  EXPECT_NEAR(bench.now().clips[0].distance_mm, 10 - 0.2 * 30, 1e-12);
  bench.run("cut front 50");
  ASSERT_EQ(bench.now().clips.size(), 1u);
  EXPECT_NEAR(bench.now().clips[0].distance_mm, -5, 1e-12);
  bench.run("cut_here");
  ASSERT_EQ(bench.now().clips.size(), 2u);
  EXPECT_NEAR(bench.now().clips[1].distance_mm, 1.0, 1e-12) << "through the middle of -4 to 6";
  bench.run("cut_deeper");
  EXPECT_NEAR(bench.now().clips[1].distance_mm, 0.8, 1e-12);
  bench.run("cut_back");
  EXPECT_NEAR(bench.now().clips[1].distance_mm, 1.0, 1e-12);
  bench.run("no_cuts");
  EXPECT_TRUE(bench.now().clips.empty());
  bench.run("fog 25");
  EXPECT_EQ(bench.now().fog, 0.25);
  EXPECT_NE(bench.refusal("cut inside 5").find("expected front, back"), std::string::npos);
}

TEST(MarkCommands, AFilmIsMadeOfWhatIsSeen) {
  Bench bench;
  bench.run("keyframe");
  bench.run("side reverse");
  bench.run("keyframe");
  bench.run("unpack 50");
  bench.run("keyframe 1");
  ASSERT_EQ(bench.now().keyframes.size(), 3u);
  EXPECT_EQ(bench.now().keyframes[1].time_s, 1.0) << "in order of time";
  EXPECT_EQ(bench.now().keyframes[2].time_s, 2.0);
  bench.run("go_to_keyframe 1");
  EXPECT_EQ(bench.now().unpack, 0.0);
  EXPECT_EQ(bench.now().now, bench.now().home);
  bench.run("play");
  EXPECT_EQ(bench.place.played_from_s.size(), 1u);
  bench.run("delete_keyframe 2");
  EXPECT_EQ(bench.now().keyframes.size(), 2u);
  const fs::path file = fs::temp_directory_path() / fmt::format("dubsar_film_{}.json", ::getpid());
  bench.run("write_film " + file.string());
  EXPECT_EQ(parse_film(read_text_file(file).value(), "film").value(), bench.now().keyframes);
  fs::remove(file);
}

TEST(MarkCommands, KeyframesAreReplacedMovedTimedAndPlayedFrom) {
  Bench bench;
  for (const char* side : {"obverse", "bottom", "reverse", "top"}) {
    bench.run(std::string("side ") + side);
    bench.run("keyframe");
  }
  const auto film = bench.now().keyframes;
  ASSERT_EQ(film.size(), 4u);
  bench.run("move_keyframe 1 3");
  const auto& moved = bench.now().keyframes;
  EXPECT_EQ(moved[0].camera, film[1].camera);
  EXPECT_EQ(moved[1].camera, film[2].camera);
  EXPECT_EQ(moved[2].camera, film[0].camera);
  EXPECT_EQ(moved[3].camera, film[3].camera);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(moved[i].time_s, film[i].time_s) << "times stay";
  bench.run("move_keyframe 3 1");
  EXPECT_EQ(bench.now().keyframes, film);
  bench.run("keyframe_seconds 2 0.5");
  EXPECT_DOUBLE_EQ(bench.now().keyframes[1].time_s, 2.0);
  EXPECT_DOUBLE_EQ(bench.now().keyframes[2].time_s, 2.5);
  EXPECT_DOUBLE_EQ(bench.now().keyframes[3].time_s, 4.5) << "what follows takes as long as before";
  EXPECT_NE(bench.refusal("keyframe_seconds 4 1").find("last keyframe"), std::string::npos);
  EXPECT_NE(bench.refusal("keyframe_seconds 1 0").find("0.05"), std::string::npos);
  EXPECT_NE(bench.refusal("move_keyframe 1 9"), "accepted");
  bench.run("play 3");
  EXPECT_EQ(bench.place.played_from_s.back(), 2.5);
  bench.run("play");
  EXPECT_FALSE(bench.place.played_from_s.back());
  bench.run("side left");
  bench.run("replace_keyframe 2");
  EXPECT_EQ(bench.now().keyframes[1].camera, bench.now().now);
  EXPECT_DOUBLE_EQ(bench.now().keyframes[1].time_s, 2.0);
  EXPECT_EQ(bench.now().keyframes[0], film[0]);
}

TEST(MarkCommands, EscapeLaysTheToolDownAndAsksBeforeItEndsASessionWithWorkInIt) {
  Bench bench;
  bench.run("tool distance");
  bench.run("close");
  EXPECT_EQ(bench.editor.ui().tool, "turn");
  EXPECT_FALSE(bench.place.ended);
  bench.run("measure_distance 0,0,0 1,0,0");
  bench.run("close");
  EXPECT_FALSE(bench.place.ended);
  EXPECT_NE(bench.place.said.find("Esc again"), std::string::npos);
  bench.run("side top");  // something else: the question is over
  bench.run("close");
  EXPECT_FALSE(bench.place.ended);
  bench.run("close");
  EXPECT_TRUE(bench.place.ended);
  Bench idle;
  idle.run("side reverse");
  idle.run("close");
  EXPECT_TRUE(idle.place.ended) << "having looked is no work";
}

TEST(MarkCommands, PicturesHaveANameASizeAndSpaces) {
  Bench bench;
  bench.run("picture");
  bench.run("picture /tmp/a b.png");
  bench.run("picture /tmp/a b.tif 4");
  EXPECT_EQ(bench.place.pictures, (std::vector<std::string>{" x1", "/tmp/a b.png x1", "/tmp/a b.tif x4"}));
}

TEST(MarkCommands, ASessionThatBeganWithNotesAsksWhenSomethingWasChanged) {
  FakePlace place;
  Document restored = two_parts();
  restored.notes.emplace_back();
  Editor editor(restored, place);
  const CommandTable commands = CommandTable::standard(kStyles);
  EXPECT_FALSE(editor.has_work()) << "all of it is kept";
  ASSERT_TRUE(commands.run("style phong", editor));
  ASSERT_TRUE(commands.run("close", editor));
  EXPECT_FALSE(place.ended);
  EXPECT_TRUE(editor.ui().leaving);
  ASSERT_TRUE(commands.run("close", editor));
  EXPECT_TRUE(place.ended);
}

}  // namespace
}  // namespace dubsar::app
