#include "core/base/text/option_list.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

TEST(OptionList, WordsValuesAndQuotedOnes) {
  const auto options = parse_options(R"(hands,device=/dev/v4l/by-path/pci-0000:00:14.0,path="a,b \"c\" \\",empty=)");
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(*options,
            (std::vector<Option>{
                {"hands"}, {"device", "/dev/v4l/by-path/pci-0000:00:14.0"}, {"path", R"(a,b "c" \)"}, {"empty", ""}}));
  EXPECT_TRUE(parse_options("").value().empty());
}

TEST(OptionList, SaysWhatIsWrongAndWhere) {
  const auto wrong = [](std::string_view text) { return parse_options(text).error().message; };
  EXPECT_NE(wrong("a,,b").find("an option is empty at \",b\""), std::string::npos) << wrong("a,,b");
  EXPECT_NE(wrong("a,").find("an option is empty"), std::string::npos);
  EXPECT_NE(wrong("=5").find("an option has no name"), std::string::npos);
  EXPECT_NE(wrong("a=\"b").find("not closed"), std::string::npos);
  EXPECT_NE(wrong("a=\"b\"c").find("behind a quotation mark"), std::string::npos);
}

TEST(OptionList, WhatIsPrintedIsReadAsTheSame) {
  std::mt19937_64 random(std::random_device{}());
  const std::string letters = "ab:,=\"\\/ -1.";
  for (int round = 0; round < 5000; ++round) {
    std::vector<Option> options(1 + random() % 4);
    const auto text = [&](std::size_t shortest) {
      std::string out;
      for (std::size_t n = shortest + random() % 6; n > 0; --n) out += letters[random() % letters.size()];
      return out;
    };
    for (Option& option : options) {
      option.key = text(1);
      if (random() % 2 == 0) option.value = text(0);
    }
    const std::string printed = options_text(options);
    const auto back = parse_options(printed);
    ASSERT_TRUE(back) << printed << ": " << back.error().message;
    ASSERT_EQ(*back, options) << printed;
    EXPECT_EQ(split_at_commas(printed).size(), options.size()) << printed;
  }
}

}  // namespace
}  // namespace dubsar
