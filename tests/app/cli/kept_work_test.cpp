// Notes are found again by the program, whatever became of the surface, of the file of the notes, and of the program.

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/files/atomic_file.h"
#include "tests/app/cli/run_program.h"
#include "tests/display/xvfb_server.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using Texts = std::set<std::string>;

class KeptWork : public ::testing::Test {
 protected:
  KeptWork() {
    fs::create_directories(folder_);
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    write_plate(plate_, 20);
  }
  ~KeptWork() override { fs::remove_all(folder_); }
  void SetUp() override {
    if (!server_.problem().empty()) GTEST_SKIP() << server_.problem();
  }
  static void write_plate(const fs::path& path, int mm) {
    std::ofstream(path)
        << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        << fmt::format("0 0 0\n{0} 0 0\n{0} {0} 0\n0 {0} 0\n3 0 1 2\n3 0 2 3\n", mm);
  }
  /// A window in which somebody says this, then ends it as with Escape.
  ProgramRun view(const std::vector<fs::path>& files, const std::string& says, const RunOptions& options = {}) {
    const fs::path steps = folder_ / fmt::format("steps{}.txt", ++runs_);
    std::ofstream(steps) << says << "+0.1 close\n+0.1 close\n+0.1 close\n+0.1 close\n";
    std::vector<std::string> arguments{"view"};
    for (const fs::path& file : files) arguments.push_back(file.string());
    for (const char* each : {"--windowed", "--size", "160x120", "--seconds", "100", "--bridge-port", "0", "--steps"})
      arguments.emplace_back(each);
    arguments.push_back(steps.string());
    return run_dubsar(arguments, options);
  }
  /// What notes a window shows, after `says`.
  Texts notes(const fs::path& file, const std::string& says = {}) {
    const fs::path found = folder_ / "found.json";
    fs::remove(found);
    const ProgramRun run = view({file}, says + "+0.1 write_notes " + found.string() + "\n");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    err_ = run.err;
    return texts_of(found);
  }
  static Texts texts_of(const fs::path& file) {
    Texts out;
    const auto text = read_text_file(file);
    if (!text) return {"nothing was written"};
    const auto all = nlohmann::json::parse(*text);
    for (const auto& note : all.at("notes")) out.insert(note.at("text").get<std::string>());
    return out;
  }
  std::vector<fs::path> kept_files() const {
    std::vector<fs::path> out;
    for (const auto& each : fs::recursive_directory_iterator(folder_))
      if (each.path().extension() == ".json" && each.path().string().find("recent") == std::string::npos &&
          each.path().parent_path().filename() != "undo" &&
          read_text_file(each.path()).value().find("dubsar document") != std::string::npos)
        out.push_back(each.path());
    return out;
  }
  const testing::XvfbServer server_;
  const fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_kept_work_{}", ::getpid());
  const fs::path plate_ = folder_ / "plate.ply";
  std::string err_;
  int runs_ = 0;
};

TEST_F(KeptWork, AfterARenameACopyAndAMove) {
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 ONE\n"), Texts{"ONE"});
  EXPECT_TRUE(fs::exists(plate_.string() + ".dubsar.json"));
  fs::create_directories(folder_ / "elsewhere");
  fs::copy_file(plate_, folder_ / "elsewhere" / "copy.ply");
  EXPECT_EQ(notes(folder_ / "elsewhere" / "copy.ply"), Texts{"ONE"});
  fs::rename(plate_, folder_ / "renamed.ply");
  fs::remove_all(folder_ / "state");
  EXPECT_EQ(notes(folder_ / "renamed.ply"), Texts{"ONE"});
}

TEST_F(KeptWork, WhenTheScanIsProcessedAgain) {
  const std::string scan = (folder_ / "t.h5").string(), surface = (folder_ / "s.exa").string();
  ASSERT_EQ(run_dubsar({"phantom", scan, "--size", "40x32x40", "-q"}).exit_code, 0);
  ASSERT_EQ(run_dubsar({"process", scan, "-o", surface, "-q", "--no-ao"}).exit_code, 0);
  EXPECT_EQ(notes(surface, "0.1 add_note 10,3,20 OLD\n"), Texts{"OLD"});
  ASSERT_EQ(run_dubsar({"process", scan, "-o", surface, "-q", "--no-ao", "--threshold-factor", "2.2"}).exit_code, 0);
  EXPECT_EQ(notes(surface, "0.1 turn_left\n"), Texts());
  EXPECT_EQ(notes(surface, "0.1 add_note 10,3,20 NEW\n+0.1 take_over\n"), (Texts{"NEW", "OLD"}));
  EXPECT_EQ(notes(surface), (Texts{"NEW", "OLD"}));
  ASSERT_EQ(run_dubsar({"process", scan, "-o", surface, "-q", "--no-ao"}).exit_code, 0);
  EXPECT_EQ(notes(surface), Texts{"OLD"}) << "the first surface is there again";
}

TEST_F(KeptWork, WhenANewerProgramWroteThemOrTheyAreDamaged) {
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 ONE\n"), Texts{"ONE"});
  std::vector<std::string> texts;
  for (const fs::path& file : kept_files()) {
    std::string text = read_text_file(file).value();
    text.replace(text.find("\"version\": "), 12, "\"version\": 99");
    std::ofstream(file) << text;
    texts.push_back(text);
  }
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(notes(plate_, "0.1 style raking\n"), Texts());
  EXPECT_NE(err_.find("version 99"), std::string::npos) << err_;
  int there = 0;
  for (const auto& each : fs::recursive_directory_iterator(folder_))
    if (each.is_regular_file() && each.path().string().find(".orphan-") != std::string::npos) {
      EXPECT_EQ(read_text_file(each.path()).value(), texts[0]) << each.path();
      ++there;
      std::ofstream(each.path()) << texts[0].substr(0, 400);
    }
  EXPECT_EQ(there, 2);
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 TWO\n"), Texts{"TWO"});
  EXPECT_EQ(notes(plate_), Texts{"TWO"});
}

TEST_F(KeptWork, WhatStoodBesideStandsThereAgainAndItsAbsenceIsSaid) {
  const fs::path other = folder_ / "other.ply";
  write_plate(other, 30);
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 ONE\n+0.1 set_beside " + other.string() + "\n+0.2 difference\n"),
            Texts{"ONE"});
  const std::string kept = read_text_file(plate_.string() + ".dubsar.json").value();
  EXPECT_NE(kept.find("\"path\": \"" + other.string() + "\""), std::string::npos) << kept;
  EXPECT_EQ(notes(plate_, "0.1 difference 0.5\n"), Texts{"ONE"}) << "it is there to be compared with";
  EXPECT_EQ(err_.find("other.ply"), std::string::npos) << err_;
  fs::rename(other, folder_ / "moved.ply");
  EXPECT_EQ(notes(plate_, "0.3 turn_left\n"), Texts{"ONE"});
  EXPECT_NE(err_.find("other.ply"), std::string::npos) << err_;
  EXPECT_NE(read_text_file(plate_.string() + ".dubsar.json").value().find("other.ply"), std::string::npos)
      << "it may come back";
}

TEST_F(KeptWork, WhichWasSetAsideIsListedTakenOverAndDeletedByItsNumber) {
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 ONE\n"), Texts{"ONE"});
  write_plate(plate_, 25);
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 TWO\n"), Texts{"TWO"});
  const auto set_aside = [&] {
    std::size_t count = 0;
    for (const auto& each : fs::recursive_directory_iterator(folder_))
      count += each.path().string().find(".orphan-") != std::string::npos ? 1 : 0;
    return count;
  };
  ASSERT_GT(set_aside(), 0u);
  EXPECT_EQ(notes(plate_, "0.1 drawer files\n+0.1 delete_work 1\n"), Texts{"TWO"});
  EXPECT_GT(set_aside(), 0u) << "it was asked for once only";
  EXPECT_EQ(notes(plate_, "0.1 drawer files\n+0.1 take_over 1\n+0.1 undo\n"), Texts{"TWO"});
  EXPECT_EQ(notes(plate_, "0.1 delete_work 1\n+0.1 delete_work 1\n"), Texts{"TWO"});
  EXPECT_EQ(set_aside(), 0u);
  EXPECT_EQ(notes(plate_, "0.1 take_over\n"), Texts{"TWO"}) << "none is left";
}

TEST_F(KeptWork, OfTwoWindowsAtOnce) {
  const auto both = [&](const std::string& a, const std::string& b) {
    const std::vector<std::string> view{"view",    plate_.string(), "--windowed", "--size",
                                        "160x120", "--bridge-port", "0"};
    const auto window = [&](const std::string& text, double wait_s, const char* name) {
      std::ofstream(folder_ / name) << fmt::format("0.1 add_note 3,3,0 {}\n+{} close\n+0.1 close\n+0.1 close\n", text,
                                                   wait_s);
      std::vector<std::string> arguments = view;
      arguments.insert(arguments.end(), {"--seconds", "100", "--steps", (folder_ / name).string()});
      return run_dubsar(arguments).exit_code;
    };
    auto other = std::async(std::launch::async, window, b, 2.5, "b.txt");
    EXPECT_EQ(window(a, 0.7, "a.txt"), 0);
    EXPECT_EQ(other.get(), 0);
  };
  both("A", "B");
  EXPECT_EQ(notes(plate_), (Texts{"A", "B"}));
}

TEST_F(KeptWork, WhenTheDiskIsFull) {
  RunOptions full;
  full.file_size_limit = 100;
  const ProgramRun run = view({plate_}, "0.1 add_note 3,3,0 ONE\n", full);
  EXPECT_EQ(run.exit_code, 74) << run.err;
  EXPECT_NE(run.err.find("plate.ply.dubsar.json"), std::string::npos) << run.err;
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 TWO\n"), Texts{"TWO"}) << "nothing torn is in the way";
}

TEST_F(KeptWork, AndUndoOutlivesAnotherFile) {
  const fs::path other = folder_ / "other.ply";
  write_plate(other, 30);
  const fs::path before = folder_ / "before.json", after = folder_ / "after.json", redone = folder_ / "redone.json";
  const ProgramRun run = view(
      {plate_, other}, fmt::format("0.1 add_note 3,3,0 ONE\n+0.1 add_note 5,5,0 TWO\n+0.1 undo\n+0.1 style raking\n"
                                   "+0.1 next_file\n+0.3 add_note 9,9,0 OTHER\n+0.1 previous_file\n"
                                   "+0.3 write_notes {}\n+0.1 undo\n+0.1 undo\n+0.1 write_notes {}\n"
                                   "+0.1 redo\n+0.1 write_notes {}\n",
                                   before.string(), after.string(), redone.string()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(texts_of(before), Texts{"ONE"});
  EXPECT_EQ(texts_of(after), Texts());
  EXPECT_EQ(texts_of(redone), Texts{"ONE"});
  EXPECT_EQ(notes(other), Texts{"OTHER"});
}

TEST_F(KeptWork, AndUndoOutlivesTheSession) {
  const fs::path one = folder_ / "one.json", both = folder_ / "both.json";
  EXPECT_EQ(notes(plate_, "0.1 add_note 3,3,0 ONE\n+0.1 add_note 5,5,0 TWO\n+0.1 add_note 7,7,0 THREE\n+0.1 undo\n"),
            (Texts{"ONE", "TWO"}));
  fs::rename(plate_, folder_ / "renamed.ply");
  const fs::path renamed = folder_ / "renamed.ply";
  EXPECT_EQ(notes(renamed, fmt::format("0.1 redo\n+0.1 write_notes {}\n+0.1 undo\n+0.1 undo\n", both.string())),
            Texts{"ONE"});
  EXPECT_EQ(texts_of(both), (Texts{"ONE", "TWO", "THREE"})) << "what was undone in the first session";
  EXPECT_EQ(notes(renamed, fmt::format("0.1 undo\n+0.1 write_notes {}\n+0.1 redo\n+0.1 redo\n", one.string())),
            (Texts{"ONE", "TWO"}));
  EXPECT_EQ(texts_of(one), Texts());
  // Somebody else works on it without those steps: they are none of this work any more.
  fs::remove_all(folder_ / "state" / "dubsar" / "sessions" / "undo");
  const ProgramRun without = view({renamed}, "0.1 undo\n");
  EXPECT_NE(without.err.find("there is nothing to do it to now"), std::string::npos) << without.err;
  EXPECT_EQ(notes(renamed), (Texts{"ONE", "TWO"}));
}

}  // namespace
}  // namespace dubsar::test
