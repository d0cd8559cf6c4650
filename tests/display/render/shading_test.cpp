// Presets, the light, and the table of colours, without GL.

#include "display/render/shading.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/relief/curvature/shape_colors.h"

namespace dubsar {
namespace {

TEST(Shading, EveryPresetHasItsNameAndOthersAreRefused) {
  for (const auto name : shading_preset_names()) EXPECT_TRUE(shading_preset(name)) << name;
  const auto other = shading_preset("shiny");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::kUsage);
  EXPECT_NE(other.error().message.find("relief"), std::string::npos);
}

TEST(Shading, LightComesFromTheCompassPointOfThePicture) {
  Light s;
  s.elevation_deg = 30;
  const struct {
    double azimuth;
    int x, y;
  } cases[] = {{0, 0, 1}, {90, 1, 0}, {180, 0, -1}, {270, -1, 0}, {315, -1, 1}};
  for (const auto& c : cases) {
    s.azimuth_deg = c.azimuth;
    const glm::dvec3 l = light_direction(s);
    EXPECT_NEAR(glm::length(l), 1, 1e-12);
    EXPECT_NEAR(l.z, 0.5, 1e-12);
    EXPECT_EQ(std::lround(l.x * 1.3), c.x) << c.azimuth;
    EXPECT_EQ(std::lround(l.y * 1.3), c.y) << c.azimuth;
  }
}

TEST(Shading, AmbientOcclusionScalesEveryColourOfTheTable) {
  for (const ColorMap map : {ColorMap::kPlain, ColorMap::kTable, ColorMap::kBlackWhite, ColorMap::kSkySun}) {
    Style s;
    s.map = map;
    s.occlusion_power = 1;
    s.ambient_occlusion = true;
    const auto table = color_table(s);
    ASSERT_EQ(table.size(), 128u * 64u);
    s.ambient_occlusion = false;
    const auto open = color_table(s);
    for (int shape = 0; shape < 128; ++shape) {
      EXPECT_EQ(table[63 * 128 + shape], open[shape]);
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(table[shape][c], 0);
        EXPECT_NEAR(table[21 * 128 + shape][c], open[shape][c] / 3.0, 0.51);
        EXPECT_EQ(open[5 * 128 + shape][c], open[shape][c]);
      }
    }
  }
}

TEST(Shading, ConcaveIsDarkAndConvexIsLight) {
  for (const char* preset : {"black-white", "sky-sun"}) {
    const auto table = color_table(shading_preset(preset).value().style);
    const auto red = [&](int curvedness, int shape) { return static_cast<int>(table[1 + 9 * curvedness + shape][0]); };
    const int flat = table[0][0];
    EXPECT_LT(red(13, 0), flat);       // cup
    EXPECT_LT(red(13, 2), flat);       // rut
    EXPECT_GT(red(13, 6), flat);       // ridge
    EXPECT_GT(red(13, 8), flat);       // cap
    EXPECT_LT(red(13, 0), red(6, 0));  // the sharper, the darker
    EXPECT_GT(red(13, 8), red(6, 8));
  }
}

TEST(Shading, UnlitPresetsAreTheTablesOfTheExporters) {
  const struct {
    const char* preset;
    ShapeColors colors;
  } cases[] = {{"table-ao", ShapeColors::kTable},
               {"black-white-ao", ShapeColors::kBlackWhite},
               {"sky-sun-ao", ShapeColors::kSkySun}};
  for (const auto& c : cases) {
    const auto table = color_table(shading_preset(c.preset).value().style);
    for (int ao = 0; ao < 64; ++ao)
      for (int shape = 0; shape < 127; ++shape) {
        const ShapeRgb expected = shade(shape_color_table(c.colors)[shape], static_cast<std::uint8_t>(ao));
        const auto& entry = table[ao * 128 + shape];
        ASSERT_EQ((ShapeRgb{entry[0], entry[1], entry[2]}), expected) << c.preset << " " << shape << " " << ao;
      }
  }
}

TEST(Shading, ReliefKeepsItsHueAndDarkensWedges) {
  const Shading relief = shading_preset("relief").value();
  const auto table = color_table(relief.style);
  const auto& flat = table[63 * 128];
  EXPECT_EQ((Rgb8{flat[0], flat[1], flat[2]}), relief.style.base_color);
  const auto& wedge = table[48 * 128 + 1 + 9 * 9 + 2];  // a rut of 3 voxels' radius that sees 3/4 of the sky
  EXPECT_LT(wedge[0], 0.6 * flat[0]);
  for (const auto& color : table)
    for (int c = 1; c < 3; ++c)
      ASSERT_NEAR(color[c], color[0] * relief.style.base_color[c] / 203.0, 2.0) << "another hue";
}

TEST(Shading, PartitionColoursDifferInLightness) {
  const auto colors = distinct_partition_colors();
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < a; ++b) EXPECT_NE(colors[a], colors[b]);
}

}  // namespace
}  // namespace dubsar
