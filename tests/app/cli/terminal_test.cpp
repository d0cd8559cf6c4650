// The program on a terminal of 60 columns: nothing it says is longer, and progress is one line that goes away.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/base/result.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

/// All that a terminal of `columns` columns gets to see.
std::string on_terminal(int columns, const std::vector<std::string>& arguments) {
  const int mine = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (mine < 0 || ::grantpt(mine) != 0 || ::unlockpt(mine) != 0) return {};
  const std::string theirs = ::ptsname(mine);
  const winsize size{24, static_cast<unsigned short>(columns), 0, 0};
  ::ioctl(mine, TIOCSWINSZ, &size);
  const pid_t child = ::fork();
  if (child == 0) {
    ::setsid();
    const int terminal = ::open(theirs.c_str(), O_RDWR);
    for (const int stream : {0, 1, 2}) ::dup2(terminal, stream);
    ::setenv("TERM", "xterm", 1);
    std::vector<char*> argv{const_cast<char*>(DUBSAR_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execv(DUBSAR_PROGRAM, argv.data());
    ::_exit(127);
  }
  std::string seen;
  char buffer[4096];
  for (;;) {
    pollfd wait{mine, POLLIN, 0};
    if (::poll(&wait, 1, 120000) <= 0) break;
    const ssize_t count = ::read(mine, buffer, sizeof buffer);
    if (count <= 0) break;  // EIO: the other side is closed
    seen.append(buffer, static_cast<std::size_t>(count));
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ::close(mine);
  EXPECT_TRUE(WIFEXITED(status)) << seen;
  return seen;
}

/// Lines as they stood on the screen, escape sequences left out; a line that was drawn anew counts each time.
std::vector<std::string> lines_of(const std::string& seen) {
  std::vector<std::string> lines(1);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (seen[k] == '\x1b') {
      while (k < seen.size() && !std::isalpha(static_cast<unsigned char>(seen[k]))) ++k;
    } else if (seen[k] == '\n' || seen[k] == '\r') {
      lines.emplace_back();
    } else {
      lines.back() += seen[k];
    }
  }
  return lines;
}

std::size_t letters(const std::string& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

TEST(Terminal, HelpFitsSixtyColumns) {
  for (const char* verb : {"process", "info", "export", "render", "view", "devices"})
    for (const std::string& line : lines_of(on_terminal(60, {verb, "--help"})))
      EXPECT_TRUE(line.size() <= 60 || line.starts_with("  dubsar ")) << verb << ": " << line;  // examples stay whole
  for (const std::string& line : lines_of(on_terminal(60, {}))) EXPECT_LE(line.size(), 60u) << line;
}

TEST(Terminal, ProgressIsOneLineThatFitsAndGoesAway) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_terminal_{}", ::getpid());
  fs::create_directories(folder);
  const std::string scan = (folder / "s.h5").string();
  ASSERT_EQ(run_dubsar({"phantom", scan, "--size", "160x96x160", "--seed", "5"}).exit_code, 0);
  const std::string seen = on_terminal(60, {"process", scan, "-o", (folder / "s.exa").string(), "--no-ao"});
  EXPECT_THAT(seen, ::testing::HasSubstr(" %  0:0"));
  EXPECT_THAT(seen, ::testing::HasSubstr("\r\x1b[K"));
  const std::vector<std::string> lines = lines_of(seen);
  for (const std::string& line : lines)
    EXPECT_TRUE(line.size() < 60 || line.find(" %  0:") == std::string::npos) << line;
  const std::size_t last = seen.rfind(" %  0:"), result = seen.find("  tablet  ");  // of its sizes
  ASSERT_NE(result, std::string::npos) << seen;
  EXPECT_LT(last, result) << "nothing is drawn over the result";
  EXPECT_NE(seen.find("\r\x1b[K", last), std::string::npos);
  for (const std::string& line : lines) EXPECT_LE(letters(line), 60u) << "what is said meanwhile: " << line;
  for (const char* const file : {"s.h5", "s.exa"})
    for (const std::string& line : lines_of(on_terminal(60, {"info", (folder / file).string()})))
      EXPECT_LE(letters(line), 60u) << line;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dubsar::test
