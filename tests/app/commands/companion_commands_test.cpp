// Another surface beside the present one, as commands say it; and how it is kept.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/document/document_file.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/files/kept_file.h"
#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

class CompanionCommands : public ::testing::Test {
 protected:
  CompanionCommands() {
    fs::create_directories(folder_);
    for (const char* name : {"b.exa", "c.ply"}) std::ofstream(folder_ / name) << name;
  }
  ~CompanionCommands() override { fs::remove_all(folder_); }
  std::string file(const char* name) const { return (folder_ / name).string(); }
  fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_companions_{}", ::getpid());
};

TEST_F(CompanionCommands, AreUndoneAndDoneAgain) {
  Bench bench;
  const Document before = bench.now();
  bench.run("set_beside " + file("b.exa"));
  EXPECT_EQ(bench.now().companion.path, file("b.exa"));
  EXPECT_EQ(bench.now().companion.content, file_checksum(file("b.exa")).value());
  bench.run("difference");
  EXPECT_EQ(bench.now().companion.difference_mm, 0.25);
  bench.run("difference 0.1");
  EXPECT_EQ(bench.now().companion.difference_mm, 0.1);
  bench.run("difference");
  EXPECT_EQ(bench.now().companion.difference_mm, 0.0);
  bench.run("take_away");
  EXPECT_EQ(bench.now(), before);
  for (int i = 0; i < 4; ++i) bench.run("undo");
  EXPECT_EQ(bench.now().companion.path, file("b.exa"));
  bench.run("undo");
  EXPECT_EQ(bench.now(), before);
  bench.run("redo");
  EXPECT_EQ(bench.now().companion.path, file("b.exa"));
}

TEST_F(CompanionCommands, WithoutANameTakeTheNextOpenFileOrAskForOne) {
  Bench bench;
  bench.run("set_beside");
  EXPECT_TRUE(bench.editor.ui().choosing.open && bench.editor.ui().choosing.beside);
  bench.run("open");
  bench.run("open");
  EXPECT_TRUE(bench.editor.ui().choosing.open && !bench.editor.ui().choosing.beside);
  bench.place.next = file("c.ply");
  bench.run("set_beside");
  EXPECT_EQ(bench.now().companion.path, file("c.ply"));
  bench.run("set_beside");
  EXPECT_EQ(bench.now().companion, Companion()) << "away again";
}

TEST_F(CompanionCommands, RefuseWhatIsNotThere) {
  Bench bench;
  EXPECT_NE(bench.refusal("set_beside " + file("none.exa")).find("none.exa"), std::string::npos);
  std::ofstream(folder_ / "text.txt") << "no surface";
  EXPECT_NE(bench.refusal("set_beside " + file("text.txt")).find("is no surface by its name"), std::string::npos);
  EXPECT_EQ(bench.refusal("take_away"), "take_away: there is nothing to do it to now");
  EXPECT_EQ(bench.refusal("difference"), "difference: there is nothing to do it to now");
  bench.run("set_beside " + file("b.exa"));
  EXPECT_NE(bench.refusal("difference 7"), "accepted");
  EXPECT_EQ(bench.now().companion.difference_mm, 0.0);
}

TEST_F(CompanionCommands, WhatStandsBesideIsKeptAndReadAgain) {
  Bench bench;
  bench.run("set_beside " + file("b.exa"));
  bench.run("difference 0.5");
  const auto again = parse_document(format_document(bench.now()), "kept");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->companion, bench.now().companion);
  std::string far = format_document(bench.now());
  const std::size_t at = far.find("\"difference_mm\": 0.5");
  ASSERT_NE(at, std::string::npos);
  far.replace(at, 20, "\"difference_mm\": 9.5");
  EXPECT_FALSE(parse_document(far, "far"));
}

TEST_F(CompanionCommands, WorkThatWasSetAsideIsTakenOverOneByOneAndDeletedOnceItIsSaidTwice) {
  Bench bench, first, second;
  first.run("add_note 1,2,3 a-na");
  second.run("add_note 4,5,6 um-ma");
  const auto aside = [&](const char* name, const Bench& from) {
    const Work work{from.now(), {{{name, 1}}}};
    EXPECT_TRUE(write_file_atomically(file(name), format_work(work)));
    return OtherWork{work, file(name), true, {}};
  };
  OtherWork old = aside("a.exa.dubsar.json.orphan-2026-11-20", first);
  const OtherWork newer = aside("a.exa.dubsar.json.orphan-2026-11-27", second);
  fs::copy_file(old.file, file("state.json.orphan-2026-11-20"));
  old.copies = {file("state.json.orphan-2026-11-20")};
  OtherWork elsewhere = newer;
  elsewhere.file = file("other.exa.dubsar.json");
  std::ofstream(elsewhere.file) << format_work(newer.work);
  bench.editor.set_others({old, newer, elsewhere});
  bench.run("take_over 2");
  EXPECT_EQ(bench.now().notes, second.now().notes);
  EXPECT_NE(bench.refusal("delete_work 3").find("another surface's work"), std::string::npos);
  EXPECT_NE(bench.refusal("take_over 4"), "accepted");
  bench.run("delete_work 1");
  EXPECT_TRUE(fs::exists(old.file)) << "it asks";
  bench.run("delete_work 2");
  EXPECT_TRUE(fs::exists(newer.file)) << "each is asked for by itself";
  bench.run("delete_work none");
  bench.run("delete_work 1");
  EXPECT_TRUE(fs::exists(old.file));
  bench.run("delete_work 1");
  EXPECT_FALSE(fs::exists(old.file) || fs::exists(old.copies[0])) << "with its copy";
  EXPECT_TRUE(fs::exists(newer.file) && fs::exists(elsewhere.file));
  ASSERT_EQ(bench.editor.others().size(), 2u);
  // What somebody changed meanwhile stays.
  std::ofstream(newer.file) << format_work({second.now(), {{{"a.exa.dubsar.json.orphan-2026-11-27", 2}}}});
  bench.run("delete_work 1");
  EXPECT_NE(bench.refusal("delete_work 1").find("was changed"), std::string::npos);
  EXPECT_TRUE(fs::exists(newer.file));
  EXPECT_EQ(set_aside_day(newer.file), "2026-11-27");
  EXPECT_EQ(set_aside_day(elsewhere.file), "");
}

}  // namespace
}  // namespace dubsar::app
