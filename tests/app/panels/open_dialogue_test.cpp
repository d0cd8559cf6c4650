// What the open dialogue lists, and how it speaks of a file that is being read.

#include "app/panels/open_dialogue.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace dubsar::app {
namespace {

FilesState some_files() {
  FilesState out;
  out.recent = {{"/tablets/ao 8295.exa", true}, {"/gone/bm 1.exa", false}};
  out.listing =
      FolderListing{"/tablets", {{"joins", true, 0}, {"ao 8295.exa", false, 2'900'000}, {"b.ply", false, 10}}, {}};
  return out;
}

TEST(OpenDialogue, ListsRecentFilesThenTheFolder) {
  const auto rows = dialogue_rows(some_files(), "");
  std::vector<std::string> commands;
  commands.reserve(rows.size());
  for (const DialogueRow& row : rows) commands.push_back(row.command);
  EXPECT_EQ(commands,
            (std::vector<std::string>{"", "open_recent 1", "", "", "open_folder ..", "open_folder /tablets/joins",
                                      "open /tablets/ao 8295.exa", "open /tablets/b.ply"}));
  EXPECT_EQ(rows[1].detail, "/tablets");
  EXPECT_FALSE(rows[2].heading);
  EXPECT_EQ(rows[2].detail, "not there any more") << "grey, and cannot be chosen";
  EXPECT_EQ(rows[6].detail, "2.9 MB");
}

TEST(OpenDialogue, WordsFindFilesAndPathsAreTakenAsTheyAre) {
  const auto found = dialogue_rows(some_files(), "AO 82");
  EXPECT_EQ(std::count_if(found.begin(), found.end(), [](const auto& row) { return !row.command.empty(); }), 2);
  EXPECT_EQ(dialogue_rows(some_files(), "/x/y.exa").front().command, "open /x/y.exa");
  EXPECT_EQ(dialogue_rows(some_files(), "/x").front().command, "open_folder /x");
  EXPECT_EQ(dialogue_rows(some_files(), "..").front().command, "open_folder ..");
  EXPECT_EQ(dialogue_rows(some_files(), "qqq").back().words, "nothing here is called so");
}

TEST(OpenDialogue, ReadingIsSaidInWords) {
  EXPECT_EQ(opening_words({"a.exa", 0.0, {}}), "reading a.exa");
  EXPECT_EQ(title_words("", {}), "");
  EXPECT_EQ(title_words("a.exa", {}), "a.exa");
  EXPECT_EQ(title_words("", JobState{"a.exa", 0.434, 8.0}), "reading a.exa: 43 %") << "how long it takes is no name";
  EXPECT_EQ(title_words("a.exa", JobState{"b.exa", 0.5, {}}), "a.exa, reading b.exa: 50 %");
  EXPECT_EQ(opening_words({"a.exa", 0.434, {}}), "reading a.exa: 43 %");
  EXPECT_EQ(opening_words({"a.exa", 0.5, 21.0}), "reading a.exa: 50 %, about 20 s to go");
}

}  // namespace
}  // namespace dubsar::app
