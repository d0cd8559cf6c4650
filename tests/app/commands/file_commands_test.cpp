// Commands that open files.

#include <gtest/gtest.h>

#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {

TEST(FileCommands, OpenWithoutANameShowsTheDialogueAndAFileClosesIt) {
  Bench bench;
  bench.run("open");
  EXPECT_TRUE(bench.editor.ui().choosing.open);
  bench.run("open");
  EXPECT_FALSE(bench.editor.ui().choosing.open);
  bench.run("open");
  EXPECT_EQ(bench.refusal("open missing.exa"), "missing.exa: there is no such file");
  EXPECT_TRUE(bench.editor.ui().choosing.open) << "it is still to be chosen";
  bench.run("open a name with blanks.exa");
  EXPECT_FALSE(bench.editor.ui().choosing.open);
  bench.run("open_recent 3");
  bench.run("next_file");
  bench.run("previous_file");
  EXPECT_EQ(bench.place.opened, (std::vector<std::string>{"a name with blanks.exa", "recent 3", "step 1", "step -1"}));
  EXPECT_NE(bench.refusal("open_recent 0"), "accepted");
  EXPECT_NE(bench.refusal("open_recent 11"), "accepted");
}

TEST(FileCommands, FoldersAreGoneThroughFromThePresentOne) {
  Bench bench;
  bench.run("open_folder tmp");
  EXPECT_EQ(bench.editor.ui().choosing.folder, "/tmp");
  EXPECT_TRUE(bench.editor.ui().choosing.open);
  bench.run("open_folder ..");
  EXPECT_EQ(bench.editor.ui().choosing.folder, "/");
  EXPECT_EQ(bench.refusal("open_folder not_there"), "open_folder: /not_there is no folder");
  EXPECT_EQ(bench.editor.ui().choosing.folder, "/");
}

TEST(FileCommands, EscapeStopsReadingThenClosesTheDialogueThenEnds) {
  Bench bench;
  bench.place.opening = true;
  bench.run("open");
  bench.run("close");
  EXPECT_FALSE(bench.place.opening);
  EXPECT_TRUE(bench.editor.ui().choosing.open);
  bench.run("close");
  EXPECT_FALSE(bench.editor.ui().choosing.open);
  EXPECT_FALSE(bench.place.ended);
  bench.run("close");
  EXPECT_TRUE(bench.place.ended);
  bench.run("stop_opening");
  EXPECT_EQ(bench.place.said, "no file is being read");
}

TEST(FileCommands, NoneOfThemIsAStepOfTheDocument) {
  Bench bench;
  for (const char* text : {"open", "open a.exa", "open_folder tmp", "open_recent 1", "next_file", "previous_file"})
    bench.run(text);
  EXPECT_EQ(bench.refusal("undo"), "undo: there is nothing to do it to now");
}

}  // namespace
}  // namespace dubsar::app
