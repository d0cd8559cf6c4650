// What a terminal of 60 columns shows while something is made: a real terminal, its lines as they stand on it.

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

constexpr int kColumns = 60;

struct Terminal {
  std::vector<std::string> drawn;  ///< each state of the line that is drawn again and again
  std::vector<std::string> lines;  ///< what stands there at the end
  std::size_t widest = 0;
  int exit_code = -1;
};

/// As a terminal does it: carriage return, "clear to the end of the line", new line; other escapes are skipped.
Terminal shown_by(const std::string& bytes) {
  Terminal out;
  std::string line;
  std::size_t at = 0;
  const auto keep = [&] {
    if (!line.empty()) out.drawn.push_back(line);
    out.widest = std::max(out.widest, line.size());
  };
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char c = bytes[i];
    if (c == '\r') {
      keep();
      at = 0;
    } else if (c == '\n') {
      keep();
      out.lines.push_back(line);
      line.clear();
      at = 0;
    } else if (c == '\x1b' && i + 1 < bytes.size() && bytes[i + 1] == '[') {
      std::size_t end = i + 2;
      while (end < bytes.size() && (bytes[end] < '@' || bytes[end] > '~')) ++end;
      if (end < bytes.size() && bytes[end] == 'K') line.resize(std::min(at, line.size()));
      i = end;
    } else if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) {  // letters of several bytes count once
      if (at >= line.size()) line.resize(at + 1, ' ');
      line[at++] = c;
    }
  }
  keep();
  return out;
}

Terminal run_in_terminal(const std::vector<std::string>& arguments) {
  winsize size{};
  size.ws_col = kColumns;
  size.ws_row = 24;
  int master = -1;
  const pid_t child = ::forkpty(&master, nullptr, nullptr, &size);
  if (child == 0) {
    std::vector<char*> argv{const_cast<char*>(DUBSAR_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execv(DUBSAR_PROGRAM, argv.data());
    ::_exit(127);
  }
  std::string bytes;
  char buffer[4096];
  for (ssize_t count; (count = ::read(master, buffer, sizeof buffer)) > 0;)
    bytes.append(buffer, static_cast<std::size_t>(count));
  ::close(master);
  int status = 0;
  ::waitpid(child, &status, 0);
  Terminal out = shown_by(bytes);
  out.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return out;
}

TEST(NarrowTerminal, ProgressIsOneLineOfSixtyColumnsThatNeverGoesBack) {
  const fs::path folder = fs::temp_directory_path() / ("dubsar_narrow_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const std::string scan = (folder / "scan.h5").string(), surface = (folder / "tablet.exa").string();
  const Terminal made = run_in_terminal({"phantom", scan, "--size", "160x96x160", "--seed", "5"});
  const Terminal done = run_in_terminal({"process", scan, "-o", surface});
  fs::remove_all(folder);
  for (const Terminal* const each : {&made, &done}) {
    ASSERT_EQ(each->exit_code, 0);
    double before = -1.0;
    int drawn = 0;
    for (const std::string& line : each->drawn) {
      const std::size_t percent = line.find(" %  ");
      if (percent == std::string::npos || percent < 4) continue;
      ++drawn;
      EXPECT_LT(line.size(), static_cast<std::size_t>(kColumns)) << "\"" << line << "\" would be broken";
      EXPECT_NE(line.find(':', percent), std::string::npos) << "how long it has taken: " << line;
      const double now = std::atof(line.substr(percent - 3, 3).c_str());
      if (each == &done) {
        EXPECT_GE(now, before) << "the whole, not each stage: " << line;
      }
      before = now;
    }
    EXPECT_GE(drawn, 1);
    for (const std::string& line : each->lines)
      EXPECT_EQ(line.find(" %  "), std::string::npos) << "progress is cleared when it is over: " << line;
  }
}

}  // namespace
}  // namespace dubsar::test
