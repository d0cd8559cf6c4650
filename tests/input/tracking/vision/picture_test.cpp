// Crops of pictures, and boxes from anchors.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "input/tracking/vision/picture_crop.h"
#include "input/tracking/vision/ssd_anchors.h"

namespace dubsar {
namespace {

/// Levels that rise with x in red and with y in green; blue is 200.
struct Ramp {
  std::vector<std::uint8_t> pixels;
  PictureView view;
  Ramp(int width, int height)
      : pixels(static_cast<std::size_t>(width * height * 3)), view{pixels.data(), width, height} {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        std::uint8_t* pixel = pixels.data() + 3 * (y * width + x);
        pixel[0] = static_cast<std::uint8_t>(x);
        pixel[1] = static_cast<std::uint8_t>(y);
        pixel[2] = 200;
      }
  }
};

TEST(PictureCrop, AnyScaleAndTurnSamplesTheRampWhereItSays) {
  const Ramp ramp(240, 200);
  PictureSampler sampler;
  for (const double side : {20.0, 64.0, 100.0, 130.0})
    for (const double turn : {0.0, 0.4, -1.2, 3.0}) {
      const SquareCrop crop{{118.3, 97.8}, side, turn};
      const int size = 24;
      std::vector<float> planes(3 * size * size);
      sampler.sample(ramp.view, crop, size, 1.0f, 0.0f, planes);
      for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
          const glm::dvec2 at = crop.to_picture({(column + 0.5) / size, (row + 0.5) / size});
          const std::size_t i = static_cast<std::size_t>(row * size + column);
          ASSERT_NEAR(planes[i], at.x - 0.5, 0.51) << side << ' ' << turn;  // reduced pictures are rounded to levels
          ASSERT_NEAR(planes[i + size * size], at.y - 0.5, 0.51) << side << ' ' << turn;
          ASSERT_NEAR(planes[i + 2 * size * size], 200.0, 1e-3);
        }
    }
}

TEST(PictureCrop, TheWholePictureIsCentredBetweenBlackBars) {
  const Ramp ramp(160, 80);
  std::vector<float> planes(3 * 16 * 16);
  PictureSampler().sample(ramp.view, whole_picture(ramp.view), 16, 2.0f / 255.0f, -1.0f, planes);
  for (int row = 0; row < 16; ++row)
    EXPECT_NEAR(planes[2 * 256 + static_cast<std::size_t>(row * 16 + 8)],
                row >= 4 && row < 12 ? 2.0 * 200 / 255 - 1 : -1.0, 1e-5)
        << row;
}

TEST(PictureCrop, CropsOutsideOfThePictureAreBlack) {
  const Ramp ramp(32, 32);
  std::vector<float> planes(3 * 8 * 8);
  for (const SquareCrop& crop : {SquareCrop{{-500, 10}, 50, 0}, SquareCrop{{10, 10}, 0, 0},
                                 SquareCrop{{10, 10}, std::nan(""), 0}, SquareCrop{{1e300, 0}, 10, 0}}) {
    PictureSampler().sample(ramp.view, crop, 8, 1.0f, 7.0f, planes);
    for (const float level : planes) ASSERT_EQ(level, 7.0f);
  }
}

TEST(SsdAnchors, TheGridsOfTheFaceNetworkHave896Anchors) {
  const auto anchors = make_anchors(std::array{AnchorGrid{16, 2}, AnchorGrid{8, 6}});
  ASSERT_EQ(anchors.size(), 896U);
  EXPECT_NEAR(anchors[0].x, 0.03125, 1e-12);
  EXPECT_NEAR(anchors[511].y, 0.96875, 1e-12);
  EXPECT_NEAR(anchors[512].x, 0.0625, 1e-12);
}

TEST(SsdAnchors, BoxesAndPointsAreOffsetsFromTheirAnchorInPixels) {
  const auto anchors = make_anchors(std::array{AnchorGrid{2, 1}});
  std::vector<float> boxes(4 * 6, 0.0f), scores{-5.0f, -5.0f, -5.0f, 2.0f};
  const std::array<float, 6> raw{10, -20, 40, 20, -5, 15};
  std::copy(raw.begin(), raw.end(), boxes.begin() + 3 * 6);
  const auto found = decode_ssd(boxes, scores, anchors, 1, 100.0, 0.5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].score, 1.0 / (1.0 + std::exp(-2.0)), 1e-9);
  EXPECT_NEAR(found[0].least.x, 0.75 + 0.10 - 0.20, 1e-6);
  EXPECT_NEAR(found[0].most.y, 0.75 - 0.20 + 0.10, 1e-6);
  EXPECT_NEAR(found[0].points[0].x, 0.70, 1e-6);
  EXPECT_NEAR(found[0].points[0].y, 0.90, 1e-6);
}

TEST(SsdAnchors, NotFiniteOffsetsAreDropped) {
  const auto anchors = make_anchors(std::array{AnchorGrid{1, 1}});
  const std::vector<float> scores{3.0f};
  for (const float bad : {std::nanf(""), INFINITY, -3.0f})
    EXPECT_TRUE(decode_ssd(std::vector<float>{0, 0, bad, 5}, scores, anchors, 0, 10, 0.5).empty());
}

TEST(SsdAnchors, OverlappingDetectionsBecomeTheirWeightedMeanAndOthersStay) {
  const auto box = [](double score, double x) {
    SsdDetection d;
    d.score = score;
    d.least = {x, 0.1};
    d.most = {x + 0.2, 0.3};
    d.points[0] = {x, 0.0};
    return d;
  };
  const auto merged = merge_overlapping({box(0.5, 0.12), box(0.9, 0.6), box(1.0, 0.1)}, 0.3);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_EQ(merged[0].score, 1.0);
  EXPECT_NEAR(merged[0].least.x, (1.0 * 0.1 + 0.5 * 0.12) / 1.5, 1e-12);
  EXPECT_NEAR(merged[0].points[0].x, merged[0].least.x, 1e-12);
  EXPECT_NEAR(merged[1].least.x, 0.6, 1e-12);
}

}  // namespace
}  // namespace dubsar
