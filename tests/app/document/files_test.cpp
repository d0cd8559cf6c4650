// The list of recent files, and what an open dialogue finds in a folder.

#include <gtest/gtest.h>

#include "app/document/file_kinds.h"
#include "app/document/folder_listing.h"
#include "app/document/recent_files.h"
#include "core/base/files/atomic_file.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar::app {
namespace {

using RecentFiles = testing_tools::TempFolder;
using FolderListingTest = testing_tools::TempFolder;

TEST_F(RecentFiles, NewestStandFirstEachOnceAndTenAtMost) {
  const auto list = in("state/dubsar/recent.json");
  EXPECT_TRUE(read_recent(list).empty());
  for (int i = 1; i <= 13; ++i) ASSERT_TRUE(remember_recent(list, in(fmt::format("tablet {}.exa", i))));
  ASSERT_TRUE(remember_recent(list, folder() / "." / "tablet 9.exa"));
  std::vector<std::string> expected;
  for (const int i : {9, 13, 12, 11, 10, 8, 7, 6, 5, 4})
    expected.push_back(in(fmt::format("tablet {}.exa", i)).string());
  EXPECT_EQ(read_recent(list), expected);
  EXPECT_TRUE(remember_recent({}, in("a.exa"))) << "no state folder: nothing is kept";
}

TEST_F(RecentFiles, ADamagedListIsEmptyAndIsReplaced) {
  const auto list = in("recent.json");
  for (const char* text : {"", "{", "[]", "{\"format\": \"other\", \"files\": [\"/a.exa\"]}",
                           "{\"format\": \"dubsar recent files\", \"files\": 3}",
                           "{\"format\": \"dubsar recent files\", \"files\": [3, \"relative.exa\", null]}"}) {
    write_bytes(list, text);
    EXPECT_TRUE(read_recent(list).empty()) << text;
  }
  ASSERT_TRUE(remember_recent(list, "/a b/\xc5\xa1.exa"));
  EXPECT_EQ(read_recent(list), std::vector<std::string>{"/a b/\xc5\xa1.exa"});
}

TEST_F(FolderListingTest, ShowsFoldersThenSurfacesByNameWhateverTheirCapitals) {
  for (const char* name : {"zeta", "Alpha", ".hidden"}) std::filesystem::create_directories(in(name));
  for (const char* name : {"b.EXA", "a.ply", "C.obj", "d.stl", "e.Glb", "scan.h5", "notes.txt", ".secret.exa", "exa"})
    write_bytes(in(name), "12345");
  const FolderListing found = list_folder(folder() / "zeta" / "..");
  EXPECT_EQ(found.problem, "");
  EXPECT_EQ(std::filesystem::path(found.folder), folder() / "");
  std::vector<std::string> names;
  for (const FolderEntry& entry : found.entries) names.push_back(entry.name + (entry.folder ? "/" : ""));
  EXPECT_EQ(names, (std::vector<std::string>{"Alpha/", "zeta/", "a.ply", "b.EXA", "C.obj", "d.stl", "e.Glb"}));
  EXPECT_EQ(found.entries[2].bytes, 5);
  EXPECT_NE(list_folder(in("nowhere")).problem, "");
}

TEST(SizeWords, AreShort) {
  EXPECT_EQ(size_words(999), "999 B");
  EXPECT_EQ(size_words(730'400), "730 kB");
  EXPECT_EQ(size_words(2'901'985), "2.9 MB");
  EXPECT_EQ(size_words(73'400'000'000), "73.4 GB");
}

}  // namespace
}  // namespace dubsar::app
