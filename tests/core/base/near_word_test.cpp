#include "core/base/text/near_word.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

const std::vector<std::string> kStyles{"relief", "phong", "raking", "table", "ao", "table-ao"};

TEST(NearWord, OneSlipInShortWordsAndTwoInLongOnes) {
  EXPECT_EQ(near_word("rakin", kStyles), "raking");
  EXPECT_EQ(near_word("arking", kStyles), "raking") << "two letters exchanged";
  EXPECT_EQ(near_word("Relef", kStyles), "relief");
  EXPECT_EQ(near_word("pong", kStyles), "phong");
  EXPECT_EQ(near_word("pog", kStyles), "") << "two slips in three letters";
  EXPECT_EQ(near_word("sculpture", kStyles), "");
}

TEST(NearWord, TheBeginningOfTheOnlyWordThatBeginsSo) {
  EXPECT_EQ(near_word("rel", kStyles), "relief");
  const std::vector<std::string> panels{"looking-glass-go", "looking-glass-portrait", "spatiallabs-15.6"};
  EXPECT_EQ(near_word("spatial", panels), "spatiallabs-15.6");
  EXPECT_EQ(near_word("looking", panels), "") << "two begin so";
}

TEST(NearWord, WhatIsRightOrEmptyOrEndlessMeansNothingElse) {
  EXPECT_EQ(near_word("ao", kStyles), "");
  EXPECT_EQ(near_word("", kStyles), "");
  EXPECT_EQ(near_word("4", std::vector<std::string>{"3", "5"}), "");
  EXPECT_EQ(near_word(std::string(100000, 'a'), kStyles), "");
}

TEST(NearWord, EndsASentence) {
  EXPECT_EQ(did_you_mean("rakin", "relief, phong, raking"), "; did you mean \"raking\"?");
  EXPECT_EQ(did_you_mean("stone", "relief, phong, raking"), "");
  EXPECT_EQ(did_you_mean("relif", kStyles), "; did you mean \"relief\"?");
}

}  // namespace
}  // namespace dubsar
