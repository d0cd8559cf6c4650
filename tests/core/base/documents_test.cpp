// The pages of the project are true: every link and every path that they name exists, and comments name works that
// docs/method.md lists.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;
const fs::path kSource = DUBSAR_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> pages() {
  std::vector<fs::path> found{kSource / "README.md", kSource / "CONTRIBUTING.md", kSource / "CHANGELOG.md"};
  for (const auto& entry : fs::directory_iterator(kSource / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

TEST(Documents, LinksLeadSomewhere) {
  const std::regex link(R"(\]\(([^)#]+)(#[^)]*)?\))");
  int links = 0;
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page);
    ASSERT_FALSE(text.empty()) << page;
    for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at) {
      const std::string target = (*at)[1];
      if (target.find("://") != std::string::npos) continue;
      ++links;
      EXPECT_TRUE(fs::exists(page.parent_path() / target)) << page.filename() << " links to " << target;
    }
  }
  EXPECT_GT(links, 40) << "the pattern finds no links any more";
}

TEST(Documents, PathsInCodeStyleExist) {
  const std::regex path(R"(`((?:core|devices|input|display|app|shaders|tests|docs|examples|cmake)/[A-Za-z0-9_./-]+)`)");
  int paths = 0;
  for (const fs::path& page : pages()) {
    if (page.filename() == "CHANGELOG.md") continue;  // tells of the past
    const std::string text = text_of(page);
    for (std::sregex_iterator at(text.begin(), text.end(), path), end; at != end; ++at, ++paths)
      EXPECT_TRUE(fs::exists(kSource / (*at)[1].str())) << page.filename() << " names " << (*at)[1];
  }
  EXPECT_GT(paths, 10) << "the pattern finds no paths any more";
}

// Who looks for a folder finds in docs/architecture.md what is in it.
TEST(Documents, EveryFolderOfSourcesStandsInTheTableOfRooms) {
  const std::string page = text_of(kSource / "docs" / "architecture.md");
  std::set<std::string> folders;
  for (const char* room : {"core", "devices", "input", "display", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kSource / room)) {
      const auto suffix = entry.path().extension();
      if (suffix == ".h" || suffix == ".cpp")
        folders.insert(fs::relative(entry.path().parent_path(), kSource).string());
    }
  EXPECT_GT(folders.size(), 50U);
  for (const std::string& folder : folders)
    EXPECT_NE(page.find("](../" + folder + ")"), std::string::npos)
        << "docs/architecture.md does not say what is in " << folder;
}

TEST(Documents, CommentsNameWorksThatTheMethodLists) {
  const std::string method = text_of(kSource / "docs" / "method.md");
  std::set<std::string> keys;
  const std::regex key(R"(\[([A-Z][A-Za-z-]+(?: [A-Z][a-z]+)? \d{4})\])");
  for (std::sregex_iterator at(method.begin(), method.end(), key), end; at != end; ++at) keys.insert((*at)[1]);
  EXPECT_GT(keys.size(), 15u);
  for (const char* room : {"core", "devices", "input", "display", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kSource / room)) {
      const auto suffix = entry.path().extension();
      if (suffix != ".h" && suffix != ".cpp") continue;
      const std::string text = text_of(entry.path());
      EXPECT_EQ(text.find("design note"), std::string::npos)
          << entry.path() << " refers to a note that is not in the tree";
      for (std::sregex_iterator at(text.begin(), text.end(), key), end; at != end; ++at)
        EXPECT_TRUE(keys.count((*at)[1])) << entry.path() << " names [" << (*at)[1] << "], docs/method.md does not";
    }
}

}  // namespace
