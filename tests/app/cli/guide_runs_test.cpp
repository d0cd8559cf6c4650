// Every line of the guides is run as it stands there, in its order, in a folder of its own.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/files/atomic_file.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

/// Lines of the blocks that are marked as sh.
std::vector<std::string> shell_lines(const std::string& page) {
  std::vector<std::string> lines;
  std::istringstream text(page);
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```"))
      inside = !inside && line == "```sh";
    else if (inside && !line.empty())
      lines.push_back(line);
  }
  return lines;
}

struct Folder {
  fs::path path = fs::temp_directory_path() / fmt::format("dubsar_guide_{}", ::getpid());
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

/// Exit code of a line in a folder, with the program of this build on the PATH; what it says in `said`.
int run_line(const fs::path& folder, const std::string& line, std::string& said) {
  const fs::path program = DUBSAR_PROGRAM;
  const std::string command = fmt::format("cd '{}' && PATH='{}':\"$PATH\" && {{ {} ; }} > said.txt 2>&1",
                                          folder.string(), program.parent_path().string(), line);
  const int status = std::system(command.c_str());
  said = read_text_file(folder / "said.txt").value_or("");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class Guide : public ::testing::TestWithParam<const char*> {};

TEST_P(Guide, EveryLineRuns) {
  const auto page = read_text_file(fs::path(DUBSAR_SOURCE_DIR) / "docs" / GetParam());
  ASSERT_TRUE(page) << page.error().message;
  const std::vector<std::string> lines = shell_lines(*page);
  ASSERT_GE(lines.size(), 5u);
  const Folder folder;
  for (const std::string& line : lines) {
    std::string said;
    EXPECT_EQ(run_line(folder.path, line, said), 0) << line << "\n" << said;
  }
}

INSTANTIATE_TEST_SUITE_P(Docs, Guide, ::testing::Values("terminal.md"));

// A report in a browser, where there is one: its viewer draws the surface with the browser's own graphics.
TEST(Report, IsShownByABrowser) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  const Folder folder;
  std::string said;
  ASSERT_EQ(run_line(folder.path,
                     "dubsar phantom s.h5 --size 160x96x160 --seed 5 && dubsar process s.h5 --no-ao -q && "
                     "dubsar report s.exa --dpi 60",
                     said),
            0)
      << said;
  const std::string browser =
      "timeout 100 chromium --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --user-data-dir=profile --virtual-time-budget=20000 --dump-dom "
      "\"file://$PWD/s_report.html\" 2>/dev/null";
  if (run_line(folder.path, browser, said) != 0 || said.find("<html") == std::string::npos)
    GTEST_SKIP() << "chromium cannot run here";
  if (said.find("data-viewer=\"none\"") != std::string::npos) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_NE(said.find("data-viewer=\"shown\""), std::string::npos) << said.substr(0, 500);
  const std::size_t lit = said.find("data-lit=\"");
  ASSERT_NE(lit, std::string::npos);
  EXPECT_GT(std::atof(said.c_str() + lit + 10), 5.0) << "per cent of the picture that is not background";
}

}  // namespace
}  // namespace dubsar::test
