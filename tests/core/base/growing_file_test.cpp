#include "core/base/files/growing_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class GrowingFiles : public ::testing::Test {
 protected:
  GrowingFiles() { fs::create_directories(folder_); }
  ~GrowingFiles() override { fs::remove_all(folder_); }
  std::string text(const char* name) const { return read_text_file(folder_ / name).value_or("none"); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  const fs::path folder_ =
      fs::temp_directory_path() / ("dubsar_growing_" + std::to_string(::getpid()) + "_" +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(GrowingFiles, WhatWasAppendedOutlivesAKilledProcess) {
  const pid_t child = ::fork();
  if (child == 0) {
    auto file = GrowingFile::create(folder_ / "a");
    if (file && file->append("one\n") && file->append("two\n")) ::raise(SIGKILL);
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
  EXPECT_EQ(text("a"), "one\ntwo\n");
}

TEST_F(GrowingFiles, AnOlderFileStaysUntilTheNewOneIsFinished) {
  std::ofstream(folder_ / "a") << "old";
  {
    auto file = GrowingFile::create(folder_ / "a").value();
    ASSERT_TRUE(file.append("half"));
    EXPECT_FALSE(file.has_its_name());
    EXPECT_EQ(text("a"), "old");
  }  // never finished
  EXPECT_EQ(text("a"), "old");
  EXPECT_EQ(text("a.partial"), "half");
  auto file = GrowingFile::create(folder_ / "a").value();  // the half one is kept, too
  ASSERT_TRUE(file.append("new"));
  ASSERT_TRUE(file.finish());
  EXPECT_TRUE(file.has_its_name());
  EXPECT_EQ(text("a"), "new");
  EXPECT_EQ(text("a.partial"), "half");
  EXPECT_EQ(files(), 2u);
}

TEST_F(GrowingFiles, DiscardingLeavesNoTrace) {
  GrowingFile::create(folder_ / "a").value().discard();
  EXPECT_EQ(files(), 0u);
  std::ofstream(folder_ / "b") << "old";
  GrowingFile::create(folder_ / "b").value().discard();
  EXPECT_EQ(text("b"), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(GrowingFiles, LinksAndFifosStayWhatTheyAre) {
  std::ofstream(folder_ / "a") << "old";
  fs::create_symlink("a", folder_ / "link");
  auto file = GrowingFile::create(folder_ / "link").value();
  ASSERT_TRUE(file.append("new"));
  ASSERT_TRUE(file.finish());
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(text("a"), "new");
  fs::create_symlink("nowhere", folder_ / "dangling");
  EXPECT_EQ(GrowingFile::create(folder_ / "dangling").error().kind, ErrorKind::kCannotCreate);
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  EXPECT_FALSE(GrowingFile::create(folder_ / "fifo"));  // nobody reads it; it does not wait for ever
  EXPECT_TRUE(fs::is_fifo(folder_ / "fifo"));
  auto null = GrowingFile::create("/dev/null").value();
  EXPECT_TRUE(null.append("gone"));
  EXPECT_TRUE(null.finish());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(GrowingFiles, SaysWhyItCannotBeMade) {
  EXPECT_EQ(GrowingFile::create(folder_).error().kind, ErrorKind::kCannotCreate);
  EXPECT_EQ(GrowingFile::create(folder_ / "no" / "a").error().kind, ErrorKind::kCannotCreate);
  EXPECT_EQ(GrowingFile::create("/dev/full").value().append("x").error().kind, ErrorKind::kIo);
}

}  // namespace
}  // namespace dubsar
