#include "core/base/files/named_scratch.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <sstream>

namespace dubsar {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream out;
  out << std::ifstream(path).rdbuf();
  return out.str();
}

TEST(NamedScratch, HasANameOfItsOwnAndGoesWithItsOwner) {
  std::filesystem::path first_path, second_path;
  {
    const auto first = NamedScratch::create("dubsar_test", ".json", "one"),
               second = NamedScratch::create("dubsar_test", ".json", "two");
    ASSERT_TRUE(first && second);
    first_path = (*first)->path(), second_path = (*second)->path();
    EXPECT_NE(first_path, second_path);
    EXPECT_EQ(first_path.extension(), ".json") << "who is given it knows what it is by its name";
    EXPECT_EQ(text_of(first_path), "one");
    EXPECT_EQ(text_of(second_path), "two");
    struct stat facts {};
    ASSERT_EQ(::stat(first_path.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777u, 0600u) << "notes are for nobody else";
  }
  EXPECT_FALSE(std::filesystem::exists(first_path));
  EXPECT_FALSE(std::filesystem::exists(second_path));
}

TEST(NamedScratch, SaysWhereThereIsNoFolder) {
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("TMPDIR", "/no/such/folder", 1);
  const auto made = NamedScratch::create("dubsar_test", ".json", "one");
  if (before != nullptr)
    ::setenv("TMPDIR", kept.c_str(), 1);
  else
    ::unsetenv("TMPDIR");
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("temporary files"), std::string::npos) << made.error().message;
}

}  // namespace
}  // namespace dubsar
