// Every command line of the guide runs.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "core/base/files/atomic_file.h"
#include "tests/app/cli/run_program.h"
#include "tests/display/xvfb_server.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

TEST(GuideLines, EachCommandLineRuns) {
  const testing::XvfbServer server(800, 600);
  const fs::path before = fs::current_path();
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_guide_{}", ::getpid());
  fs::create_directories(folder);
  fs::current_path(folder);
  ::setenv("XDG_STATE_HOME", folder.c_str(), 1);
  ASSERT_EQ(run_dubsar({"phantom", "scan.h5", "--preset", "tiny"}).exit_code, 0);
  const std::string page = read_text_file(DUBSAR_GUIDE).value();
  std::istringstream indented(page);
  std::ofstream steps("steps.txt");
  for (std::string line; std::getline(indented, line);)
    if (line.starts_with("    ")) steps << line << "\n";
  steps.close();
  std::istringstream text(page);
  int lines = 0;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("dubsar ")) continue;
    ++lines;
    std::vector<std::string> arguments;
    std::istringstream words(line.substr(7));
    for (std::string word; words >> std::quoted(word);) arguments.push_back(word);
    const bool window = arguments[0] == "view" && line.find("--offscreen") == std::string::npos;
    if (window && !server.problem().empty()) continue;
    if (window) arguments.insert(arguments.end(), {"--seconds", "0.5", "--windowed"});
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 0) << line << "\n" << run.err;
  }
  EXPECT_EQ(lines, 20);
  EXPECT_TRUE(fs::exists("pictures"));
  EXPECT_TRUE(fs::exists("reverse.png"));
  EXPECT_TRUE(fs::exists("film/picture_00009.png"));
  EXPECT_TRUE(fs::exists("tablet.tif"));
  fs::current_path(before);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dubsar::test
