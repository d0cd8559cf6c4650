#include "display/render/images/test_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace dubsar {
namespace {

TEST(TestPattern, EveryViewLooksDifferentAndColoursGoRoundOnce) {
  std::set<std::string> pictures;
  for (int i = 0; i < 100; ++i) {
    const Image image = numbered_view(160, 200, i, 100);
    pictures.emplace(image.pixels.begin(), image.pixels.end());
  }
  EXPECT_EQ(pictures.size(), 100u);
  EXPECT_EQ(pattern_color(0, 6), (Rgb8{255, 0, 0}));
  EXPECT_EQ(pattern_color(1, 6), (Rgb8{255, 255, 0}));
  EXPECT_EQ(pattern_color(2, 6), (Rgb8{0, 255, 0}));
  EXPECT_EQ(pattern_color(4, 6), (Rgb8{0, 0, 255}));
  EXPECT_EQ(pattern_color(1, 2), (Rgb8{0, 255, 255}));
}

TEST(TestPattern, TheNumberIsWrittenUprightAndLeftToRight) {
  // 7 dots high at a scale of side / 21: at 210 x 210 a dot has 10 pixels; "1" is a stem with a foot of three dots.
  const Image image = numbered_view(210, 210, 1, 48);
  const auto white = [&](int dot_x, int dot_y) {
    const std::uint8_t* p = image.at(105 - 25 + dot_x * 10 + 5, 105 - 35 + dot_y * 10 + 5);
    return p[0] == 255 && p[1] == 255 && p[2] == 255;
  };
  for (int y = 0; y < 7; ++y) EXPECT_TRUE(white(2, y)) << y;
  EXPECT_TRUE(white(1, 1)) << "the serif is at the left of the top";
  EXPECT_FALSE(white(3, 1));
  EXPECT_TRUE(white(1, 6) && white(3, 6)) << "the foot is at the bottom";
  EXPECT_FALSE(white(0, 6));
}

TEST(TestPattern, TheSmallestViewsDoNotWriteOutside) {
  for (const int w : {1, 2, 9})
    for (const int h : {1, 3, 8})
      EXPECT_EQ(numbered_view(w, h, 99, 100).pixels.size(), static_cast<std::size_t>(w * h * 4));
}

}  // namespace
}  // namespace dubsar
