#include "display/panels/panel_profile.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <numeric>

#include "core/base/atomic_file.h"
#include "display/optics/optics.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

const std::vector<PanelProfile>& built_in() {
  static const std::vector<PanelProfile> profiles = load_profiles("/nonexistent").value();
  return profiles;
}

/// The makers' templates (design note: displays, section 1.5). Pitch 0: no figures are published.
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
  for (const PanelProfile& profile : built_in()) models += profile.kind == PanelKind::kLookingGlass;
  EXPECT_EQ(models, std::size(rows));
  for (const Row& row : rows) {
    const auto profile = find_profile(built_in(), row.name);
    ASSERT_TRUE(profile) << row.name;
    EXPECT_EQ(profile->serial_prefix, row.serial) << row.name;
    EXPECT_EQ(profile->width_px, row.width) << row.name;
    EXPECT_EQ(profile->height_px, row.height) << row.name;
    EXPECT_NEAR(profile->width_mm, row.width / row.dpi * 25.4, 1e-9) << row.name;
    EXPECT_EQ(profile->view_cone_deg, row.cone) << row.name;
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
  EXPECT_EQ(find_profile(built_in(), "looking-glass-portrait")->quilt.tile_width(), 420);
  EXPECT_EQ(find_profile(built_in(), "looking-glass-portrait")->quilt.tile_height(), 560);
  EXPECT_EQ(find_profile(built_in(), "looking-glass-go")->quilt.tile_width(), 372);
  EXPECT_EQ(find_profile(built_in(), "looking-glass-go")->quilt.tile_height(), 682);
}

TEST(PanelProfile, CellsOfTheThirdGenerationAreTheMakers) {
  const auto cells = [](const char* name) { return find_profile(built_in(), name)->sheet->cells; };
  const SubpixelCell p0{{glm::dvec2{-.25, -.31}, {-.25, .28}, {.25, 0}}},
      p1{{glm::dvec2{.25, -.31}, {.25, .28}, {-.25, 0}}};
  const SubpixelCell l0{{glm::dvec2{-.31, .25}, {.28, .25}, {0, -.25}}},
      l1{{glm::dvec2{-.31, -.25}, {.28, -.25}, {0, .25}}};
  EXPECT_EQ(cells("looking-glass-16-gen3-portrait"), (std::vector{p0, p1}));
  EXPECT_EQ(cells("looking-glass-16-gen3-landscape"), (std::vector{l0, l1}));
  EXPECT_EQ(find_profile(built_in(), "looking-glass-16-gen3-portrait")->sheet->pattern, CellPattern::kRows);
  EXPECT_EQ(find_profile(built_in(), "looking-glass-16-gen3-landscape")->sheet->pattern, CellPattern::kColumns);
}

TEST(PanelProfile, AnUnknownNameListsTheKnownOnes) {
  const auto profile = find_profile(built_in(), "nothing");
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().kind, ErrorKind::kUsage);
  EXPECT_NE(profile.error().message.find("spatiallabs-15.6"), std::string::npos);
}

TEST(PanelProfile, AUsersFileReplacesTheProfileOfTheSameName) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_profiles_{}", ::getpid());
  fs::create_directories(folder);
  ASSERT_TRUE(write_file_atomically(folder / "mine.json", R"({"name": "lens-sheet-24-5-views", "kind": "lens_sheet",
      "width_px": 1920, "height_px": 1080, "dpi": 90, "view_cone_deg": 22, "views": 7, "lens": {"pitch": 40, "slope": 5}})"));
  const auto profiles = load_profiles(folder);
  fs::remove_all(folder);
  ASSERT_TRUE(profiles) << profiles.error().message;
  EXPECT_EQ(profiles->size(), built_in().size());
  EXPECT_EQ(find_profile(*profiles, "lens-sheet-24-5-views")->views, 7);
}

TEST(PanelProfile, ATrackedPanelSeparatesTheEyesAtItsDesignDistance) {
  for (const char* name : {"spatiallabs-15.6", "sr-32"}) {
    const PanelProfile profile = *find_profile(built_in(), name);
    const TrackedPanel panel = panel_optics(profile, profile.design_distance_mm).value();
    const double half = 0.5 * profile.ipd_mm, z = profile.design_distance_mm;
    const EyePair eyes{{-half, 0, z}, {half, 0, z}};
    EXPECT_LE(wrong_eye_light(panel, eyes, eyes, true, 64).worst(), 0.04) << name;
  }
}

constexpr const char* kWrapped = R"({"configVersion": "1.0", "serial": "LKG-P00671", "pitch": {"value": 52.594383},
  "slope": {"value": -7.211529}, "center": {"value": 0.5}, "viewCone": {"value": 40.0}, "invView": {"value": 1.0},
  "verticalAngle": {"value": 0.0}, "DPI": {"value": 324.0}, "screenW": {"value": 1536.0}, "screenH": {"value": 2048.0},
  "flipImageX": {"value": 0.0}, "flipImageY": {"value": 0.0}, "flipSubp": {"value": 0.0}})";

TEST(Calibration, WrappedAndBareNumbersAreTheSame) {
  const auto wrapped = parse_calibration(kWrapped, "visual.json");
  ASSERT_TRUE(wrapped) << wrapped.error().message;
  EXPECT_NEAR(lens_sheet(wrapped->figures).periods, 246.9732, 5e-4);
  const auto bare = parse_calibration(
      R"({"serial": "LKG-P00671", "pitch": 52.594383, "slope": -7.211529, "center": 0.5, "DPI": 324, "screenW": 1536, "screenH": 2048})",
      "b");
  ASSERT_TRUE(bare) << bare.error().message;
  EXPECT_DOUBLE_EQ(bare->figures.pitch, wrapped->figures.pitch);
}

TEST(Calibration, PicksTheModelBySerial) {
  const auto profile = calibrated_profile(built_in(), *parse_calibration(kWrapped, "visual.json"));
  ASSERT_TRUE(profile);
  EXPECT_EQ(profile->name, "looking-glass-portrait");
  EXPECT_EQ(profile->calibration, "visual.json");
  EXPECT_NEAR(profile->width_mm, 120.415, 1e-3);
}

TEST(Calibration, CellsOfTheThirdGenerationAreRead) {
  const auto read =
      parse_calibration(R"({"serial": "LKG-H1", "pitch": 44.72, "slope": -7.45, "DPI": 283, "screenW": 2160,
    "screenH": 3840, "CellPatternMode": {"value": 4}, "subpixelCells": [
      {"ROffsetX": -0.25, "ROffsetY": -0.31, "GOffsetX": -0.25, "GOffsetY": 0.28, "BOffsetX": 0.25, "BOffsetY": 0},
      {"ROffsetX": 0.25, "ROffsetY": -0.31, "GOffsetX": 0.25, "GOffsetY": 0.28, "BOffsetX": -0.25, "BOffsetY": 0}]})",
                        "h");
  ASSERT_TRUE(read) << read.error().message;
  const LensSheet sheet = lens_sheet(read->figures);
  EXPECT_EQ(sheet.subpixels.pattern, CellPattern::kRows);
  EXPECT_DOUBLE_EQ(sheet.subpixels.offset_px(7, 3, 0).x, 0.25);
  EXPECT_DOUBLE_EQ(sheet.subpixels.offset_px(7, 2, 1).y, 0.28);
  EXPECT_EQ(calibrated_profile(built_in(), *read)->name, "looking-glass-16-gen3-portrait");
}

TEST(Calibration, BadFiguresAreRefusedByNameAndRange) {
  struct Case {
    const char *json, *words;
  };
  for (const Case& c : {
           Case{R"({"pitch": 0, "slope": 1, "DPI": 300, "screenW": 100, "screenH": 100})",
                "pitch is 0, expected 5 to 500"},
           Case{R"({"pitch": 50, "slope": 0, "DPI": 300, "screenW": 100, "screenH": 100})", "slope is 0"},
           Case{R"({"pitch": 9999, "slope": 5, "DPI": 300, "screenW": 100, "screenH": 100})",
                "pitch is 9999, expected 5 to 500"},
           Case{R"({"pitch": 50, "slope": 0.1, "DPI": 300, "screenW": 100, "screenH": 100})",
                "slope is 0.1, expected 0.5 or more"},
           Case{R"({"pitch": 50, "slope": 5, "center": 1e6, "DPI": 300, "screenW": 100, "screenH": 100})",
                "center is 1000000, expected -100 to 100"},
           Case{R"({"pitch": 50, "slope": 5, "DPI": 300, "screenW": 20000, "screenH": 100})",
                "screenW is 20000, expected 1 to 16384"},
           Case{R"({"pitch": 50, "slope": 5, "DPI": 300, "screenW": 10.5, "screenH": 100})",
                "screenW is 10.5, expected a whole number"},
           Case{R"({"pitch": "fast", "slope": 5, "DPI": 300, "screenW": 10, "screenH": 100})", "pitch is string"},
           Case{R"({"pitch": 50, "slope": 5, "screenW": 10, "screenH": 100})", "DPI is missing"},
           Case{R"({"pitch": 1e999, "slope": 5, "DPI": 300, "screenW": 10, "screenH": 100})",
                "the JSON text is broken"},
           Case{R"([1, 2])", "expected an object"},
           Case{R"({"pitch": )", "the JSON text is broken"},
           Case{"", "the JSON text is broken"},
           Case{R"({"pitch": 50, "slope": 5, "DPI": 300, "screenW": 10, "screenH": 100, "CellPatternMode": 7})",
                "CellPatternMode is 7, expected 0 to 4"},
       }) {
    const auto read = parse_calibration(c.json, "bad.json");
    ASSERT_FALSE(read) << c.json;
    EXPECT_EQ(read.error().kind, ErrorKind::kConfig);
    EXPECT_NE(read.error().message.find(c.words), std::string::npos) << read.error().message;
  }
}

TEST(Calibration, DeepNestingAndEveryTruncationEndInASentence) {
  EXPECT_FALSE(parse_calibration(std::string(60000, '['), "deep"));
  const std::string whole = kWrapped;
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_FALSE(parse_calibration(whole.substr(0, n), "cut")) << n;
}

TEST(Calibration, IsFoundOnAMountedUnit) {
  const fs::path root = fs::temp_directory_path() / fmt::format("dubsar_media_{}", ::getpid());
  fs::create_directories(root / "LKG-P00671" / "LKG_calibration");
  fs::create_directories(root / "OTHER");
  ASSERT_TRUE(write_file_atomically(root / "LKG-P00671" / "LKG_calibration" / "visual.json", kWrapped));
  const std::vector<fs::path> roots{root, "/nonexistent"};
  const auto found = find_calibration_files(roots);
  fs::remove_all(root);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].filename(), "visual.json");
}

}  // namespace
}  // namespace dubsar
