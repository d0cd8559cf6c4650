#include "core/base/files/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_atomic_{}", ::getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }
  fs::path folder_;
};

TEST_F(AtomicFileTest, OldFileStaysUntilCommit) {
  const fs::path target = folder_ / "a.txt";
  ASSERT_TRUE(write_file_atomically(target, "old"));
  {
    auto file = AtomicFile::create(target);
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write("new and longer"));
    EXPECT_EQ(*read_text_file(target), "old");
  }
  EXPECT_EQ(*read_text_file(target), "old");
  EXPECT_EQ(files(), 1) << "the temporary file was not removed";
}

TEST_F(AtomicFileTest, CommitReplacesAndCutsReservedSpace) {
  const fs::path target = folder_ / "a.bin";
  auto file = AtomicFile::create(target, 100000);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->write("12345678"));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(*read_text_file(target), "12345678");
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFileTest, MissingFolderIsCannotCreate) {
  const auto file = AtomicFile::create(folder_ / "none" / "a.txt");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::kCannotCreate);
}

TEST_F(AtomicFileTest, ReadingAFolderOrAMissingFileSaysSo) {
  EXPECT_EQ(read_text_file(folder_).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(read_text_file(folder_ / "none").error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace dubsar
