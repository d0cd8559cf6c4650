// Files of people and of other programs are never replaced or removed.

#include "core/base/files/kept_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <set>

#include "core/base/files/atomic_file.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/files/file_lock.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class KeptFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_kept_{}", ::getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void put(const std::string& text) const { std::ofstream(file()) << text; }
  fs::path file() const { return folder_ / "a.json"; }
  std::string there() const { return read_text_file(file()).value_or("nothing"); }
  std::set<std::string> names() const {
    std::set<std::string> out;
    for (const auto& each : fs::directory_iterator(folder_)) out.insert(each.path().filename().string());
    return out;
  }
  fs::path folder_;
};

TEST_F(KeptFiles, WhatItReadOrWroteIsReplacedAndRemoved) {
  KeptFile kept(file());
  ASSERT_EQ(kept.write("one").value(), Kept::kDone) << "nothing was there";
  ASSERT_EQ(kept.write("two").value(), Kept::kDone);
  EXPECT_EQ(there(), "two");
  KeptFile another(file());
  EXPECT_EQ(**another.read(), "two");
  EXPECT_EQ(another.write("three").value(), Kept::kDone);
  EXPECT_EQ(another.remove().value(), Kept::kDone);
  EXPECT_EQ(names(), std::set<std::string>()) << "no lock, no temporary file";
}

TEST_F(KeptFiles, WhatItDoesNotKnowStays) {
  put("a person's");
  KeptFile unread(file());
  EXPECT_EQ(unread.write("ours").value(), Kept::kStranger);
  EXPECT_EQ(unread.remove().value(), Kept::kStranger);
  EXPECT_EQ(there(), "a person's");
  KeptFile read(file());
  ASSERT_TRUE(read.read());
  put("a person's, changed");
  EXPECT_EQ(read.write("ours").value(), Kept::kStranger);
  put("a person's");  // as it was read
  EXPECT_EQ(read.write("ours").value(), Kept::kDone);
  fs::remove(file());
  EXPECT_EQ(read.write("ours").value(), Kept::kStranger) << "somebody took it away on purpose";
  EXPECT_FALSE(*read.read());
  EXPECT_EQ(read.write("ours").value(), Kept::kDone);
  fs::remove(file());
  fs::create_directory(file());
  EXPECT_FALSE(read.write("ours").value_or(Kept::kStranger) == Kept::kDone);
  EXPECT_TRUE(fs::is_directory(file()));
}

TEST_F(KeptFiles, SettingAsideTakesThePlaceOfNothing) {
  std::set<std::string> texts;
  for (int i = 0; i < 4; ++i) {
    put(fmt::format("text {}", i));
    KeptFile kept(file());
    const auto aside = kept.set_aside();
    ASSERT_TRUE(aside) << aside.error().message;
    EXPECT_TRUE(aside->filename().string().starts_with("a.json.orphan-20")) << *aside;
    EXPECT_FALSE(fs::exists(file()));
    EXPECT_EQ(kept.write("ours").value(), Kept::kDone);
    fs::remove(file());
  }
  for (const fs::path& each : set_aside_of(file())) texts.insert(read_text_file(each).value());
  EXPECT_EQ(texts, (std::set<std::string>{"text 0", "text 1", "text 2", "text 3"}));
  EXPECT_EQ(KeptFile(file()).set_aside().error().kind, ErrorKind::kNoInput);
}

TEST_F(KeptFiles, TwoProcessesThatCountInOneFileLoseNoCount) {
  constexpr int kEach = 40;
  put("0");
  for (int child = 0; child < 2; ++child)
    if (::fork() == 0) {
      for (int done = 0; done < kEach;) {
        KeptFile kept(file());
        const auto text = kept.read();
        if (!text || !*text) continue;
        const auto written = kept.write(std::to_string(std::stoi(**text) + 1));
        if (written && *written == Kept::kDone) ++done;
      }
      ::_exit(0);
    }
  for (int child = 0; child < 2; ++child) ::wait(nullptr);
  EXPECT_EQ(there(), std::to_string(2 * kEach));
}

TEST_F(KeptFiles, AFileThatIsNoLockIsLeftHoweverOldItIs) {
  const fs::path strange = folder_ / ".a.json.lock";
  std::ofstream(strange) << "what somebody else keeps here\n";
  fs::last_write_time(strange, fs::file_time_type::clock::now() - std::chrono::hours(1));
  KeptFile kept(file());
  const auto refused = kept.write("ours");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kTryAgain);
  EXPECT_EQ(read_text_file(strange).value(), "what somebody else keeps here\n");
  EXPECT_FALSE(fs::exists(file()));
}

TEST_F(KeptFiles, ALockOfAProcessThatIsGoneIsBrokenAndThatOfALivingOneIsNamed) {
  const fs::path lock = folder_ / ".a.json.lock";
  const pid_t gone = ::fork();
  if (gone == 0) ::_exit(0);
  ::waitpid(gone, nullptr, 0);
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  std::ofstream(lock) << fmt::format("{} {}\n", gone, host.data());
  KeptFile kept(file());
  EXPECT_EQ(kept.write("ours").value(), Kept::kDone);
  EXPECT_FALSE(fs::exists(lock));
  std::ofstream(lock) << fmt::format("{} {}\n", ::getpid(), host.data());
  const auto refused = kept.write("more");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kTryAgain);
  EXPECT_NE(refused.error().message.find(fmt::format("process {} on {}", ::getpid(), host.data())), std::string::npos)
      << refused.error().message;
  EXPECT_EQ(there(), "ours");
}

TEST_F(KeptFiles, ChecksumsTellAnyChangedByteAndAreTheSameOfFileAndText) {
  std::string text(2'500'003, 'x');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * 2654435761U >> 13);
  put(text);
  const std::string whole = bytes_checksum(text);
  EXPECT_EQ(file_checksum(file()).value(), whole);
  std::set<std::string> others;
  for (const std::size_t at : {std::size_t{0}, std::size_t{7}, std::size_t{1'048'576}, text.size() - 1}) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    others.insert(bytes_checksum(changed));
  }
  others.insert(bytes_checksum(text + '\0'));
  EXPECT_EQ(others.size(), 5u);
  EXPECT_FALSE(others.contains(whole));
  EXPECT_TRUE(bytes_checksum("").starts_with("0-"));
}

}  // namespace
}  // namespace dubsar
