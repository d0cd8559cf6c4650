#include "core/relief/curvature/shape_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/relief/curvature/shape_class.h"

namespace dubsar {
namespace {

constexpr ShapeColors kAll[] = {ShapeColors::kTable, ShapeColors::kBlackWhite, ShapeColors::kSkySun};

double luminance(const ShapeRgb& c) {
  const auto linear = [](std::uint8_t v) {
    const double s = v / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
}

std::uint8_t class_of(int step, int shape) { return static_cast<std::uint8_t>(1 + 9 * step + shape); }

TEST(ShapeColors, FlatIsTheSameNeutralGreyInAllTables) {
  for (const auto colors : kAll) {
    const ShapeRgb flat = shape_color_table(colors)[0];
    EXPECT_EQ(flat[0], flat[1]);
    EXPECT_EQ(flat[1], flat[2]);
    EXPECT_NEAR(luminance(flat), 0.2812, 0.003);  // L* = 60
    EXPECT_EQ(shape_color_table(colors)[127], flat);
  }
}

TEST(ShapeColors, LightnessRisesFromCupToCapAndWithCurvedness) {
  for (const auto colors : kAll) {
    const auto& table = shape_color_table(colors);
    for (int step = 0; step < kCurvednessSteps; ++step)
      for (int shape = 0; shape + 1 < kShapes; ++shape)
        EXPECT_LE(luminance(table[class_of(step, shape)]), luminance(table[class_of(step, shape + 1)]) + 0.004)
            << step << " " << shape;
    for (int step = 0; step + 1 < kCurvednessSteps; ++step) {
      EXPECT_LT(luminance(table[class_of(step + 1, 8)]), 1.0);
      EXPECT_GT(luminance(table[class_of(step + 1, 8)]), luminance(table[class_of(step, 8)]));
      EXPECT_LT(luminance(table[class_of(step + 1, 0)]), luminance(table[class_of(step, 0)]));
    }
    EXPECT_GT(luminance(table[class_of(13, 8)]), luminance(table[0]) * 1.5);
    EXPECT_LT(luminance(table[class_of(13, 0)]), luminance(table[0]) / 1.8);
  }
}

TEST(ShapeColors, BlackWhiteHasNoHueAndUsesTheWholeRange) {
  for (const ShapeRgb& c : shape_color_table(ShapeColors::kBlackWhite)) {
    EXPECT_EQ(c[0], c[1]);
    EXPECT_EQ(c[1], c[2]);
  }
  EXPECT_LT(shape_color_table(ShapeColors::kBlackWhite)[class_of(13, 0)][0], 25);
  EXPECT_GT(shape_color_table(ShapeColors::kBlackWhite)[class_of(13, 8)][0], 245);
}

TEST(ShapeColors, SkySunIsBlueInHollowsAndOrangeOnRidges) {
  const auto& table = shape_color_table(ShapeColors::kSkySun);
  for (int step = 3; step < kCurvednessSteps; ++step)
    for (const int shape : {0, 1, 2}) {
      const ShapeRgb hollow = table[class_of(step, shape)], ridge = table[class_of(step, 8 - shape)];
      EXPECT_GT(hollow[2], hollow[1]);
      EXPECT_GT(hollow[1], hollow[0]);
      EXPECT_GT(ridge[0], ridge[1]);
      EXPECT_GT(ridge[1], ridge[2]);
    }
  for (int step = 0; step < kCurvednessSteps; ++step) EXPECT_EQ(table[class_of(step, 4)], table[0]);
}

TEST(ShapeColors, TableTellsAllShapesOfStrongCurvednessApart) {
  const auto& table = shape_color_table(ShapeColors::kTable);
  for (int a = 0; a < kShapes; ++a)
    for (int b = 0; b < a; ++b) {
      int difference = 0;
      for (std::size_t c = 0; c < 3; ++c) difference += std::abs(table[class_of(10, a)][c] - table[class_of(10, b)][c]);
      EXPECT_GT(difference, 30) << a << " " << b;
    }
}

TEST(ShapeColors, AmbientLightDarkensInProportion) {
  const ShapeRgb color = shape_color_table(ShapeColors::kSkySun)[class_of(9, 7)];
  EXPECT_EQ(shade(color, 0), (ShapeRgb{0, 0, 0}));
  EXPECT_EQ(shade(color, 63), color);
  EXPECT_EQ(shade(color, 200), color);
  for (std::uint8_t ao = 0; ao < 63; ++ao)
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LE(shade(color, ao)[c], shade(color, static_cast<std::uint8_t>(ao + 1))[c]);
      EXPECT_NEAR(shade(color, ao)[c], color[c] * ao / 63.0, 0.51);
    }
}

TEST(ShapeColors, VertexColorsTakeWhatIsThere) {
  const std::vector<std::uint8_t> shape{0, 60, 255}, ao{63, 30, 0};
  const auto& table = shape_color_table(ShapeColors::kTable);
  EXPECT_EQ(shape_vertex_colors(ShapeColors::kTable, shape, ao),
            (std::vector<ShapeRgb>{table[0], shade(table[60], 30), {0, 0, 0}}));
  EXPECT_EQ(shape_vertex_colors(ShapeColors::kTable, shape, {}),
            (std::vector<ShapeRgb>{table[0], table[60], table[0]}));
  EXPECT_EQ(shape_vertex_colors(ShapeColors::kTable, {}, ao)[1], shade(table[0], 30));
  EXPECT_TRUE(shape_vertex_colors(ShapeColors::kTable, {}, {}).empty());
}

}  // namespace
}  // namespace dubsar
