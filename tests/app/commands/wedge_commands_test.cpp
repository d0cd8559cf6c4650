// Wedges drawn, moved, named, ordered and deleted by commands, and pointed at; whose each is stays known.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/document/document_file.h"
#include "app/document/join.h"
#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {

/// Level wedges that a machine found, their heads at these x along the line of the bench's surface (z = 5).
std::vector<ScriptWedge> row_of(const std::vector<double>& heads) {
  std::vector<ScriptWedge> out;
  for (const double x : heads) {
    ScriptWedge w;
    w.head_mm = {x, 0, 5};
    w.corner_mm[0] = {x, 1, 5};
    w.corner_mm[1] = {x, -1, 5};
    w.tail_mm = {x + 4, 0, 5};
    w.tip_mm = {x + 0.5, 0, 4.2};
    w.depth_mm = 0.8;
    w.width_mm = 2;
    w.length_mm = 4;
    w.kind = WedgeKind::kHorizontal;
    w.line = 1;
    w.confidence = 0.9;
    out.push_back(w);
  }
  return out;
}

const TextSides kBenchSides{TabletFrame{}};

Bench& with_wedges(Bench& bench, const std::vector<double>& heads) {
  Document next = bench.now();
  take_found_wedges(next, row_of(heads), "tablet", kBenchSides);
  give_ids(next);
  bench.editor.change(std::move(next), "find_wedges");
  return bench;
}

std::vector<double> heads_of(const Document& document) {
  std::vector<double> out;
  for (const ScriptWedge& w : wedges_of(document)) out.push_back(w.head_mm.x);
  return out;
}

TEST(WedgeCommands, AClickChoosesTheWedgeAndBesideItIsLevel) {
  Bench bench;
  bench.run("tool wedge");
  bench.run("point 10,0,5");
  EXPECT_EQ(bench.place.said, "no wedges were looked for yet");
  with_wedges(bench, {0, 10, 20});
  bench.run("point 10.5,0.2,5");
  EXPECT_EQ(bench.editor.ui().pointing.wedge, 2u);
  EXPECT_EQ(bench.place.said, "2: horizontal, 0.80 mm deep, obverse, line 1 (the program's)");
  bench.run("point 30,8,5");
  EXPECT_EQ(bench.editor.ui().pointing.wedge, 0u);
  EXPECT_EQ(bench.place.said, "level here: no wedge");
}

TEST(WedgeCommands, ADepthIsThatOfTheDeepestPlaceAndBesideAWedgeThereIsNone) {
  Bench bench;
  with_wedges(bench, {0, 10});
  bench.run("tool depth");
  bench.run("point 11.5,0.1,5");
  ASSERT_EQ(bench.now().measures.size(), 1u);
  EXPECT_EQ(bench.now().measures[0].points_mm[0], glm::dvec3(10.5, 0, 4.2));
  bench.run("point 11,7,5");
  EXPECT_EQ(bench.now().measures.size(), 1u);
  EXPECT_EQ(bench.place.said, "level here: no wedge");
}

TEST(WedgeCommands, EverythingIsUndoneAndSaysWhoseItIs) {
  Bench bench;
  with_wedges(bench, {0, 10, 20});
  bench.run("tool wedge_add");
  for (const char* const place : {"point 14,1,5", "point 14,-1,5", "point 17,0,5"}) bench.run(place);
  EXPECT_EQ(heads_of(bench.now()), (std::vector<double>{0, 10, 14, 20})) << "where it stands along the line";
  EXPECT_EQ(bench.editor.ui().pointing.wedge, 3u);
  EXPECT_EQ(wedges_of(bench.now())[2].by, WedgeBy::kPerson);
  bench.run("wedge_kind 1 winkelhaken");
  EXPECT_EQ(wedges_of(bench.now())[0].by, WedgeBy::kCorrected);
  EXPECT_EQ(wedges_of(bench.now())[1].by, WedgeBy::kMachine);
  bench.run("move_wedge 2 9,0,5 12,0,5");
  EXPECT_EQ(heads_of(bench.now()), (std::vector<double>{0, 9, 14, 20}));
  EXPECT_NEAR(wedges_of(bench.now())[1].length_mm, 3.0, 1e-9);
  bench.run("wedge_order 4 1");
  EXPECT_EQ(heads_of(bench.now()), (std::vector<double>{20, 0, 9, 14}));
  EXPECT_EQ(wedges_of(bench.now())[0].order, 1);
  bench.run("wedge_line 1 2");
  EXPECT_EQ(wedges_of(bench.now())[0].line, 2);
  bench.run("delete_wedge 3");
  EXPECT_EQ(heads_of(bench.now()), (std::vector<double>{20, 0, 14}));
  EXPECT_EQ(bench.now().edition.wedges.size(), 4u) << "what the program found is remembered";
  bench.run("delete_wedge 3");
  EXPECT_EQ(bench.now().edition.wedges.size(), 3u) << "what a person drew is not";
  for (int k = 0; k < 7; ++k) bench.run("undo");
  EXPECT_EQ(heads_of(bench.now()), (std::vector<double>{0, 10, 20}));
  for (const ScriptWedge& w : wedges_of(bench.now())) EXPECT_EQ(w.by, WedgeBy::kMachine);
  EXPECT_EQ(bench.refusal("wedge_kind 9 odd"), bench.refusal("wedge_kind 9 odd"));
  EXPECT_NE(bench.refusal("wedge_kind 1 round").find("expected horizontal"), std::string::npos);
  EXPECT_NE(bench.refusal("add_wedge 1,1,5 1,1,5 4,4,5"), "accepted") << "no width";
}

TEST(WedgeCommands, WhatAPersonDidStaysWhenWedgesAreFoundAgain) {
  Bench bench;
  with_wedges(bench, {0, 10, 20, 30});
  bench.run("delete_wedge 2");
  bench.run("wedge_kind 2 vertical");  // the one at 20
  bench.run("add_wedge 40,1,5 40,-1,5 43,0,5");
  with_wedges(bench, {0.2, 10.3, 20.4, 30.1, 40.5, 50});  // a little elsewhere
  EXPECT_EQ(heads_of(bench.now()), (std::vector<double>{0.2, 20, 30.1, 40, 50}));
  EXPECT_EQ(wedges_of(bench.now())[1].kind, WedgeKind::kVertical);
  EXPECT_EQ(wedges_of(bench.now())[3].by, WedgeBy::kPerson);
}

TEST(WedgeCommands, TheTableHasWhatAPersonMadeOfThem) {
  Bench bench;
  with_wedges(bench, {0, 10});
  bench.run("wedge_kind 2 odd");
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("dubsar_wedges_{}.csv", ::getpid());
  bench.run("write_wedges " + file.string());
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_NE(text.str().find(",measured,machine,\n2,obverse,1,1,2,odd,"), std::string::npos) << text.str();
  EXPECT_NE(text.str().find(",measured,corrected,\n"), std::string::npos);
  bench.run("write_wedges " + file.string());  // again: it is ours
  std::ofstream(file) << "mine";
  EXPECT_NE(bench.refusal("write_wedges " + file.string()).find("something else is there"), std::string::npos);
  std::filesystem::remove(file);
}

TEST(WedgeCommands, TwoWindowsWedgesComeTogether) {
  Bench bench;
  with_wedges(bench, {0, 10, 20});
  Document base = bench.now(), mine = base, theirs = base;
  mine.edition.wedges[2].wedge.kind = WedgeKind::kOdd;
  theirs.edition.wedges[0].deleted = true;
  number_wedges(theirs);
  const Document both = join(&base, mine, theirs);
  EXPECT_EQ(heads_of(both), (std::vector<double>{10, 20}));
  EXPECT_EQ(wedges_of(both)[1].kind, WedgeKind::kOdd);
}

}  // namespace
}  // namespace dubsar::app
