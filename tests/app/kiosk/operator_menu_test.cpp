#include "app/kiosk/operator_menu.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar::app {
namespace {

constexpr TimestampNs kSecond = 1'000'000'000;

std::optional<OperatorWish> type(OperatorMenu& menu, std::string_view digits, TimestampNs now) {
  for (const char c : digits) menu.key(std::string(1, c), now);
  return menu.key("enter", now);
}

TEST(OperatorMenu, OpensByItsNumberAndDoesWhatItsRowsSay) {
  OperatorMenu menu("4711");
  EXPECT_FALSE(type(menu, "4711", kSecond));
  ASSERT_TRUE(menu.open());
  EXPECT_EQ(menu.key("2", kSecond), OperatorWish::kNextLanguage);
  EXPECT_TRUE(menu.open());
  EXPECT_FALSE(menu.key("x", kSecond));
  EXPECT_EQ(menu.key("9", kSecond), OperatorWish::kEnd);
  EXPECT_FALSE(menu.open());
  type(menu, "4711", 2 * kSecond);
  EXPECT_EQ(menu.key("escape", 2 * kSecond), OperatorWish::kClose);
  type(menu, "4711", 3 * kSecond);
  menu.tick(64 * kSecond);
  EXPECT_FALSE(menu.open());
}

TEST(OperatorMenu, LocksAfterFiveWrongNumbersAndForgetsHalfOnes) {
  OperatorMenu menu("4711");
  for (int i = 0; i < 5; ++i) type(menu, "1234", kSecond);
  EXPECT_TRUE(menu.locked(kSecond));
  type(menu, "4711", 20 * kSecond);
  EXPECT_FALSE(menu.open());
  type(menu, "4711", 32 * kSecond);
  EXPECT_TRUE(menu.open());
  OperatorMenu other("4711");
  other.key("4", 0);
  other.key("7", 0);
  type(other, "11", 11 * kSecond);
  EXPECT_FALSE(other.open());
}

TEST(OperatorMenu, RandomKeysDoNotOpenIt) {
  OperatorMenu menu("40961872");
  const std::vector<std::string> keys{"0", "1",     "2",      "3",  "4",  "5",   "6",    "7", "8",
                                      "9", "enter", "escape", "f4", "f1", "tab", "home", "q", "space"};
  std::mt19937 random(99173);
  TimestampNs now = 0;
  for (int i = 0; i < 10'000; ++i, now += kSecond / 20) {
    EXPECT_FALSE(menu.key(keys[random() % keys.size()], now));
    EXPECT_FALSE(menu.open());
  }
}

TEST(OperatorMenu, AFileThatComesOpensItOnce) {
  OperatorMenu menu("");
  type(menu, "", kSecond);
  EXPECT_FALSE(menu.open());
  menu.file_present(true, kSecond);
  EXPECT_TRUE(menu.open());
  menu.key("0", kSecond);
  menu.file_present(true, 2 * kSecond);
  EXPECT_FALSE(menu.open());
}

}  // namespace
}  // namespace dubsar::app
