#include "display/panels/panel_profile.h"

#include <gtest/gtest.h>

#include "display/optics/optics.h"
#include "display/panels/panel_set.h"

namespace dubsar {
namespace {

/// The makers' templates. Pitch 0: no figures are published.
TEST(PanelProfile, EveryLookingGlassModelHasItsFigures) {
  struct Row {
    const char *name, *serial;
    int width, height;
    double dpi, pitch, slope, cone;
    int quilt_width, quilt_height, columns, rows;
    double aspect;
  };
  const Row rows[] = {
      {"looking-glass-8.9", "LKG-2K", 2560, 1600, 338, 49.80, 5.48, 40, 4096, 4096, 5, 9, 1.6},
      {"looking-glass-8.9-legacy-quilt", "", 2560, 1600, 338, 49.80, 5.48, 40, 2048, 2048, 4, 8, 1.6},
      {"looking-glass-15.6", "LKG-4K", 3840, 2160, 283, 50.07, -7.7, 40, 4096, 4096, 5, 9, 1.7778},
      {"looking-glass-8k", "LKG-8K", 7680, 4320, 280, 38.05, -7.7, 40, 8192, 8192, 5, 9, 1.7778},
      {"looking-glass-portrait", "LKG-P", 1536, 2048, 324, 52, -7, 40, 3360, 3360, 8, 6, 0.75},
      {"looking-glass-16-gen2", "LKG-A", 3840, 2160, 283, 50, -7, 40, 4096, 4096, 5, 9, 1.7778},
      {"looking-glass-32-gen2", "LKG-B", 7680, 4320, 280, 42, -6, 40, 8192, 8192, 5, 9, 1.7778},
      {"looking-glass-65", "LKG-D", 7680, 4320, 136, 0, 0, 40, 8192, 8192, 8, 9, 1.7778},
      {"looking-glass-go", "LKG-E", 1440, 2560, 491, 80.7, -6.3, 54, 4092, 4092, 11, 6, 0.5625},
      {"looking-glass-kiosk", "LKG-F", 1536, 2048, 324, 52, -7, 40, 3360, 3360, 8, 6, 0.75},
      {"looking-glass-16-gen3-portrait", "LKG-H", 2160, 3840, 283, 44.72, -7.45, 50, 5995, 6000, 11, 6, 0.5625},
      {"looking-glass-16-gen3-landscape", "LKG-J", 3840, 2160, 283, 44.72, -6.9, 50, 5999, 5999, 7, 7, 1.7778},
      {"looking-glass-27-gen3-landscape", "", 3840, 2160, 163, 0, 0, 50, 7680, 4320, 8, 6, 1.7778},
      {"looking-glass-27-gen3-portrait", "", 2160, 3840, 163, 0, 0, 50, 7680, 4320, 12, 4, 0.5625},
      {"looking-glass-32-gen3-portrait", "LKG-K", 4320, 7680, 280, 0, 0, 54, 8184, 8184, 11, 6, 0.5625},
      {"looking-glass-32-gen3-landscape", "LKG-L", 7680, 4320, 280, 75, -7.2, 50, 8190, 8190, 7, 7, 1.7778}};
  std::size_t models = 0;
  for (const PanelProfile& profile : built_in_panels().profiles) models += profile.kind == PanelKind::kLookingGlass;
  EXPECT_EQ(models, std::size(rows));
  for (const Row& row : rows) {
    const auto profile = built_in_panels().find(row.name);
    ASSERT_TRUE(profile) << row.name;
    EXPECT_EQ(profile->marks.serial_prefix, row.serial) << row.name;
    EXPECT_EQ(profile->width_px, row.width) << row.name;
    EXPECT_EQ(profile->height_px, row.height) << row.name;
    EXPECT_NEAR(profile->width_mm, row.width / row.dpi * 25.4, 1e-9) << row.name;
    EXPECT_EQ(profile->zone.cone_deg, row.cone) << row.name;
    EXPECT_EQ(profile->quilt.width_px, row.quilt_width) << row.name;
    EXPECT_EQ(profile->quilt.height_px, row.quilt_height) << row.name;
    EXPECT_EQ(profile->quilt.columns, row.columns) << row.name;
    EXPECT_EQ(profile->quilt.rows, row.rows) << row.name;
    EXPECT_EQ(profile->aspect, row.aspect) << row.name;
    ASSERT_EQ(profile->sheet.has_value(), row.pitch > 0) << row.name;
    if (!profile->sheet) continue;
    EXPECT_EQ(profile->sheet->pitch, row.pitch) << row.name;
    EXPECT_EQ(profile->sheet->slope, row.slope) << row.name;
    EXPECT_TRUE(profile->sheet->invert_views) << row.name;
  }
  EXPECT_EQ(built_in_panels().find("looking-glass-portrait")->quilt.tile_width(), 420);
  EXPECT_EQ(built_in_panels().find("looking-glass-portrait")->quilt.tile_height(), 560);
  EXPECT_EQ(built_in_panels().find("looking-glass-go")->quilt.tile_width(), 372);
  EXPECT_EQ(built_in_panels().find("looking-glass-go")->quilt.tile_height(), 682);
}

TEST(PanelProfile, CentresAreTheMakers) {
  for (const auto& [name, centre] : {std::pair{"looking-glass-8.9", 0.0},
                                     {"looking-glass-portrait", 0.5},
                                     {"looking-glass-16-gen2", 0.5},
                                     {"looking-glass-32-gen2", 0.3},
                                     {"looking-glass-go", -0.3},
                                     {"looking-glass-kiosk", 0.5},
                                     {"looking-glass-16-gen3-portrait", 0.0},
                                     {"looking-glass-16-gen3-landscape", 0.5},
                                     {"looking-glass-32-gen3-landscape", -0.2}})
    EXPECT_EQ(built_in_panels().find(name)->sheet->center, centre) << name;
}

TEST(PanelProfile, CellsOfTheThirdGenerationAreTheMakers) {
  const auto cells = [](const char* name) { return built_in_panels().find(name)->sheet->cells; };
  const SubpixelCell p0{{glm::dvec2{-.25, -.31}, {-.25, .28}, {.25, 0}}},
      p1{{glm::dvec2{.25, -.31}, {.25, .28}, {-.25, 0}}};
  const SubpixelCell l0{{glm::dvec2{-.31, .25}, {.28, .25}, {0, -.25}}},
      l1{{glm::dvec2{-.31, -.25}, {.28, -.25}, {0, .25}}};
  EXPECT_EQ(cells("looking-glass-16-gen3-portrait"), (std::vector{p0, p1}));
  EXPECT_EQ(cells("looking-glass-16-gen3-landscape"), (std::vector{l0, l1}));
  EXPECT_EQ(built_in_panels().find("looking-glass-16-gen3-portrait")->sheet->pattern, CellPattern::kRows);
  EXPECT_EQ(built_in_panels().find("looking-glass-16-gen3-landscape")->sheet->pattern, CellPattern::kColumns);
}

TEST(PanelProfile, AnUnknownNameListsTheKnownOnes) {
  const auto profile = built_in_panels().find("nothing");
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().kind, ErrorKind::kUsage);
  EXPECT_NE(profile.error().message.find("spatiallabs-15.6"), std::string::npos);
}

TEST(PanelProfile, ATrackedPanelSeparatesTheEyesAtItsDesignDistance) {
  for (const char* name : {"spatiallabs-15.6", "sr-32"}) {
    const PanelProfile profile = *built_in_panels().find(name);
    const TrackedPanel panel = panel_optics(profile, profile.zone.design_distance_mm).value();
    const double half = 0.5 * profile.zone.ipd_mm, z = profile.zone.design_distance_mm;
    const EyePair eyes{{-half, 0, z}, {half, 0, z}};
    EXPECT_LE(wrong_eye_light(panel, eyes, eyes, true, 64).worst(), 0.04) << name;
  }
}

}  // namespace
}  // namespace dubsar
