// A copy of the work, and work from a copy.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "app/document/mark_file.h"
#include "core/base/files/atomic_file.h"
#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

class WorkCommands : public ::testing::Test {
 protected:
  WorkCommands() { fs::create_directories(folder_); }
  ~WorkCommands() override { fs::remove_all(folder_); }
  std::string file(const char* name) const { return (folder_ / name).string(); }
  fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_copies_{}", ::getpid());
};

TEST_F(WorkCommands, ACopyOpenedOnAnotherMachineHasAllNotesMeasuresAndKeyframesInOneStep) {
  Bench mine;
  mine.run("add_note 1,2,3 a-na");
  mine.run("add_line -1,2,3 -9,2,3 um-ma");
  mine.run("measure_distance 0,0,0 3,4,0 wedge");
  mine.run("keyframe");
  mine.run("save_copy " + file("work.json"));
  Bench theirs;
  theirs.run("add_note 5,5,5 theirs");
  theirs.run("open_work " + file("work.json"));
  EXPECT_NE(theirs.place.said.find("2 notes, 1 measure, 1 keyframe from work.json"), std::string::npos)
      << theirs.place.said;
  EXPECT_EQ(theirs.now().notes.size(), 3u);
  EXPECT_EQ(theirs.now().measures, mine.now().measures);
  EXPECT_EQ(theirs.now().keyframes, mine.now().keyframes);
  theirs.run("open_work " + file("work.json"));
  EXPECT_EQ(theirs.now().notes.size(), 3u) << "nothing comes twice";
  theirs.run("undo");
  EXPECT_EQ(theirs.now().notes.size(), 1u) << "one step";
  EXPECT_NE(theirs.refusal("open_work " + file("missing.json")), "accepted");
}

TEST_F(WorkCommands, ACopyTakesThePlaceOfAnOlderOneButNotOfAnotherPersonsWork) {
  Bench bench;
  bench.run("add_note 1,2,3 a-na");
  bench.run("save_copy " + file("work.json"));
  bench.run("add_note 1,2,4 i-na");
  bench.run("save_copy " + file("work.json"));
  Bench other;
  other.run("add_note 7,7,7 theirs");
  const std::string before = read_text_file(file("work.json")).value();
  EXPECT_NE(other.refusal("save_copy " + file("work.json")).find("that are not here"), std::string::npos);
  EXPECT_EQ(read_text_file(file("work.json")).value(), before);
}

TEST_F(WorkCommands, NotesOfTheSurfaceThatWasHereBeforeAreTakenOver) {
  Bench bench;
  bench.run("take_over");
  EXPECT_EQ(bench.place.said, "no work of another surface was found here");
  Bench before;
  before.run("add_note 1,2,3 a-na");
  bench.editor.set_others({{{before.now(), {}}, "/scans/a.exa.dubsar.json.orphan-2026-11-27", true}});
  bench.run("take_over");
  EXPECT_EQ(bench.now().notes, before.now().notes);
  EXPECT_EQ(bench.place.said, "1 note from a.exa.dubsar.json.orphan-2026-11-27");
}

// Each kind of file that the program writes, over each other one.
TEST_F(WorkCommands, FilesAreReplacedOnlyByTheirOwnKind) {
  Bench bench;
  bench.run("add_note 1,2,3 a-na");
  bench.run("measure_distance 0,0,0 3,4,0 wedge");
  bench.run("keyframe");
  const std::vector<std::string> kinds{"write_measures", "write_notes", "write_annotations", "write_film", "save_copy"};
  std::vector<std::string> texts;
  for (const std::string& kind : kinds) {
    bench.run(kind + " " + file("first.json"));
    texts.push_back(read_text_file(file("first.json")).value());
    fs::remove(file("first.json"));
  }
  std::vector<std::string> others{"{}",
                                  "",
                                  "dubsar",
                                  "{\"format\": \"dubsar kiosk\", \"version\": 1}",
                                  "{\"generator\": {\"name\": \"other\"}, \"type\": \"AnnotationCollection\"}",
                                  "{\"format\": \"dubsar measures of mine\"}",
                                  "notes on dubsar, by hand"};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (std::size_t there = 0; there < texts.size() + others.size(); ++there) {
      const std::string text = there < texts.size() ? texts[there] : others[there - texts.size()];
      std::ofstream(file("taken.json")) << text;
      const std::string refused = bench.refusal(kinds[kind] + " " + file("taken.json"));
      EXPECT_EQ(refused == "accepted", there == kind) << kinds[kind] << " over " << text.substr(0, 60);
      if (there != kind) {
        EXPECT_EQ(read_text_file(file("taken.json")).value(), text);
      }
    }
  }
}

// The reader takes whatever commands can make.
TEST_F(WorkCommands, WhateverCommandsMakeIsReadAgain) {
  std::mt19937 random(std::random_device{}());
  Bench bench;
  bench.run("add_note 505000,3605000,0 in the frame of a map");
  bench.run("add_note 505000000,3605000000,12.5 the same in mm");
  bench.run("add_note 1,2,3 " + std::string(150'000, 'x'));
  Document many = bench.now();
  many.notes.resize(10'050, many.notes[0]);
  for (std::size_t i = 3; i < many.notes.size(); ++i) many.notes[i].id.clear();
  give_ids(many);
  EXPECT_TRUE(parse_document(format_document(many), "many"));
  const std::vector<std::string> ways = ways_to_say(bench.commands);
  for (int i = 0; i < 60; ++i) {
    static_cast<void>(bench.commands.run(ways[random() % ways.size()], bench.editor));
    const std::string text = format_document(bench.now());
    const auto back = parse_document(text, "made");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(format_document(*back), text);
  }
}

}  // namespace
}  // namespace dubsar::app
