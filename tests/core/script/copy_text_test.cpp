#include "core/script/copy_text.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

CopySheet sheet_with_numbers() {
  CopySheet sheet;
  sheet.width_mm = 60.0;
  sheet.height_mm = 40.0;
  CopyLayer numbers{"obverse-numbers", "obverse line numbers", "obverse numbers", {}, {}, {}};
  for (int k = 1; k <= 3; ++k) numbers.texts.push_back({{5.0, 10.0 * k}, std::to_string(k)});
  sheet.layers.push_back(numbers);
  return sheet;
}

TEST(CopyText, NumbersOfTheTextStandBesideTheDrawingWhereTheLinesAreAsMany) {
  CopySheet sheet = sheet_with_numbers();
  const std::vector<CopyTextLine> lines{{TextSide::kObverse, "3'", "a-na"},
                                        {TextSide::kReverse, "1", "\u0161u"},
                                        {TextSide::kObverse, "4'", "um-ma"},
                                        {TextSide::kObverse, "5'", "qi\u2082"}};
  EXPECT_TRUE(add_text(sheet, lines).empty());
  EXPECT_EQ(sheet.layers[0].texts[0].text, "3'");
  EXPECT_EQ(sheet.layers[0].texts[2].text, "5'");
  const CopyLayer& text = sheet.layers.back();
  EXPECT_EQ(text.id, "text");
  ASSERT_EQ(text.texts.size(), 2u + 8u) << "two names of sides, a number and a text a line";
  EXPECT_EQ(text.texts[0].text, "obverse");
  EXPECT_EQ(text.texts[2].text, "a-na");
  EXPECT_EQ(text.texts[7].text, "reverse");
  for (const CopyText& each : text.texts) {
    EXPECT_GE(each.at.x, 60.0) << "nothing is drawn over";
    EXPECT_LT(each.at.x, sheet.width_mm);
    EXPECT_LT(each.at.y, sheet.height_mm);
  }
}

TEST(CopyText, WhereTheyAreNotTheFoundNumbersStayAndTheSideIsTold) {
  CopySheet sheet = sheet_with_numbers();
  const std::vector<CopyTextLine> lines{{TextSide::kObverse, "3'", "a-na"}};
  EXPECT_EQ(add_text(sheet, lines), std::vector<TextSide>{TextSide::kObverse});
  EXPECT_EQ(sheet.layers[0].texts[0].text, "1");
  CopySheet bare = sheet_with_numbers();
  EXPECT_TRUE(add_text(bare, {}).empty());
  EXPECT_EQ(bare.width_mm, 60.0);
}

}  // namespace
}  // namespace dubsar
