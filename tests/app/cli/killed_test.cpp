// A session that is killed at any time loses at most ten seconds of notes, and no file.

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>

#include "core/base/files/atomic_file.h"
#include "core/base/files/input_file.h"
#include "tests/app/cli/run_program.h"
#include "tests/display/xvfb_server.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMostNotes = 120;
constexpr double kEveryS = 0.2, kLostS = 10.0;

struct Folder {
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path path = fs::temp_directory_path() / fmt::format("dubsar_killed_{}", ::getpid());
};

/// A level square of 20 mm, for notes.
void write_plate(const fs::path& path) {
  std::ofstream out(path);
  out << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n20 0 0\n20 20 0\n0 20 0\n3 0 1 2\n3 0 2 3\n";
}

std::set<std::string> texts_of(const fs::path& notes) {
  std::set<std::string> out;
  const auto all = nlohmann::json::parse(read_text_file(notes).value());
  for (const auto& note : all.at("notes")) out.insert(note.at("text").get<std::string>());
  return out;
}

TEST(Killed, ASessionLosesAtMostTenSecondsOfNotesAndNoFile) {
  const testing::XvfbServer server;
  if (!server.problem().empty()) GTEST_SKIP() << server.problem();
  const Folder folder;
  ::setenv("XDG_STATE_HOME", (folder.path / "state").c_str(), 1);
  const fs::path plate = folder.path / "plate.ply";
  write_plate(plate);
  const std::string bytes = read_file_bytes(plate).value();
  std::mt19937 random(std::random_device{}());
  std::uniform_real_distribution<double> soon(0.0, 2.5);
  int made = 0;
  std::set<std::string> owed;  // notes that no crash may take away any more
  for (const double kill_after_s : {soon(random), soon(random), kLostS + 1.0}) {
    SCOPED_TRACE(fmt::format("killed {} s after its first note", kill_after_s));
    const int first = made;
    std::ofstream steps(folder.path / "steps.txt");
    for (int i = 0; i < kMostNotes; ++i)  // each leaves a file behind when it is made
      steps << fmt::format("+{} add_note {},{},0 note {}\n+0 write_notes {}\n", kEveryS, 1 + i % 18, 1 + i / 18,
                           first + i, (folder.path / fmt::format("made_{}.json", first + i)).string());
    steps.close();
    std::vector<Clock::time_point> when;  // each was there
    const auto watch = [&](const std::string&) {
      while (fs::exists(folder.path / fmt::format("made_{}.json", first + static_cast<int>(when.size()))))
        when.push_back(Clock::now());
      if (when.empty()) return 0;
      return Clock::now() - when.front() >= std::chrono::duration<double>(kill_after_s) ? SIGKILL : 0;
    };
    RunOptions options;
    options.watch = watch;
    options.timeout_s = 60;
    const ProgramRun killed = run_dubsar(
        {"view", plate.string(), "--windowed", "--size", "480x360", "--steps", (folder.path / "steps.txt").string()},
        options);
    const auto end = Clock::now();
    ASSERT_EQ(killed.exit_code, 128 + SIGKILL) << killed.err;
    for (std::size_t i = 0; i < when.size(); ++i)
      if (end - when[i] >= std::chrono::duration<double>(kLostS))
        owed.insert(fmt::format("note {}", first + static_cast<int>(i)));
    made = first + kMostNotes;

    const fs::path found = folder.path / fmt::format("found_{}.json", made);
    std::ofstream(folder.path / "again.txt") << "0.1 write_notes " << found.string() << "\n+0.1 close\n+0.1 close\n";
    const ProgramRun again = run_dubsar({"view", plate.string(), "--windowed", "--size", "480x360", "--seconds", "30",
                                         "--steps", (folder.path / "again.txt").string()});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    const std::set<std::string> there = texts_of(found);
    for (const std::string& note : owed) EXPECT_TRUE(there.contains(note)) << note << " is lost";
    for (const std::string& note : there) owed.insert(note);  // what was found again stays
    EXPECT_EQ(read_file_bytes(plate).value(), bytes);
  }
  EXPECT_GE(owed.size(), 4u);
}

}  // namespace
}  // namespace dubsar::test
