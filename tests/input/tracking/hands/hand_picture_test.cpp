#include "input/tracking/hands/hand_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dubsar {
namespace {

TEST(HandPicture, DistanceInsideIsTheDistanceToTheNearestOtherPixel) {
  constexpr int kWidth = 40, kHeight = 30;
  std::mt19937 random(3);
  std::vector<std::uint8_t> labels(kWidth * kHeight);
  for (auto& label : labels) label = random() % 12 == 0 ? 0 : 1;
  const Region region{5, 4, 33, 27, 0, 1};
  std::vector<float> distance;
  distance_inside(labels, kWidth, kHeight, region, distance);
  const int w = region.x1 - region.x0 + 2;
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x) {
      int nearest = 1 << 20;
      for (int v = region.y0 - 1; v <= region.y1; ++v)
        for (int u = region.x0 - 1; u <= region.x1; ++u)
          if (labels[static_cast<std::size_t>(v * kWidth + u)] != 1)
            nearest = std::min(nearest, (u - x) * (u - x) + (v - y) * (v - y));
      EXPECT_NEAR(distance[static_cast<std::size_t>((y - region.y0 + 1) * w + x - region.x0 + 1)], std::sqrt(nearest),
                  1e-4);
    }
}

TEST(HandPicture, RegionsAreTheConnectedBrightOnesLargestFirst) {
  constexpr int kWidth = 20, kHeight = 10;
  std::vector<std::uint8_t> picture(kWidth * kHeight, 5), labels(kWidth * kHeight);
  const auto fill = [&](int x0, int y0, int x1, int y1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) picture[static_cast<std::size_t>(y * kWidth + x)] = 50;
  };
  fill(0, 0, 3, 3);
  fill(3, 3, 8, 8);  // touches the first one at a corner only
  fill(10, 2, 19, 9);
  fill(9, 0, 10, 1);
  std::vector<std::uint32_t> stack;
  const auto regions = find_regions({picture.data(), kWidth, kHeight}, 50, 4, 2, labels, stack);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(regions[0].area_px, 63);
  EXPECT_EQ(regions[0].x1, 19);
  EXPECT_EQ(regions[1].area_px, 25);
  EXPECT_EQ(labels[9], 255);
}

TEST(HandPicture, CorrelationFindsAShiftOfATenthOfAPixel) {
  constexpr int kWidth = 120, kHeight = 60;
  const auto scene = [](double x, double y) {
    return 100.0 + 60.0 * std::sin(0.31 * x) * std::cos(0.23 * y + 0.11 * x);
  };
  for (const double truth : {17.0, 17.3, 17.5, 17.9}) {
    std::vector<std::uint8_t> left(kWidth * kHeight), right(kWidth * kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        left[static_cast<std::size_t>(y * kWidth + x)] = static_cast<std::uint8_t>(std::lround(scene(x, y)));
        right[static_cast<std::size_t>(y * kWidth + x)] =
            static_cast<std::uint8_t>(std::lround(0.8 * scene(x + truth, y) + 9));
      }
    const auto match =
        match_disk({left.data(), kWidth, kHeight}, {right.data(), kWidth, kHeight}, {70, 30}, 20, 1, 5, 40, 0.6);
    ASSERT_TRUE(match);
    EXPECT_NEAR(match->disparity_px, truth, 0.1);
    EXPECT_GT(match->score, 0.98) /* whole-pixel shifts are compared */;
  }
}

TEST(HandPicture, APictureWithoutAnythingBrightHasNoThreshold) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> picture(200 * 100);
  for (auto& pixel : picture) pixel = static_cast<std::uint8_t>(5 + random() % 4);
  EXPECT_FALSE(skin_threshold({picture.data(), 200, 100}, 0.15, 6));
}

}  // namespace
}  // namespace dubsar
