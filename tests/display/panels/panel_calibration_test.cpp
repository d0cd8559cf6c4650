#include "display/panels/panel_calibration.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

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

TEST(Calibration, TheFringeGoesIntoTheSheet) {
  const auto read = parse_calibration(
      R"({"serial": "LKG-4K-1", "pitch": 50.1, "slope": -7.7, "DPI": 283, "screenW": 3840, "screenH": 2160,
          "fringe": {"value": -0.15}})",
      "large");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_DOUBLE_EQ(lens_sheet(read->figures).fringe, -0.15);
  EXPECT_DOUBLE_EQ(calibrated_profile(built_in_panels(), *read)->sheet->fringe, -0.15);
}

TEST(Calibration, PicksTheModelBySerial) {
  const auto profile = calibrated_profile(built_in_panels(), *parse_calibration(kWrapped, "visual.json"));
  ASSERT_TRUE(profile);
  EXPECT_EQ(profile->name, "looking-glass-portrait");
  EXPECT_EQ(profile->lenses.calibration, "visual.json");
  EXPECT_NEAR(profile->width_mm, 120.415, 1e-3);
  EXPECT_EQ(profile->aspect, 1536.0 / 2048.0);
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
  EXPECT_EQ(calibrated_profile(built_in_panels(), *read)->name, "looking-glass-16-gen3-portrait");
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
                "line 1, column 11: the number 1e999 is too large"},
           Case{R"([1, 2])", "array found, expected an object"},
           Case{R"({"pitch": )", "line 1, column 11: the text ends here, expected a value"},
           Case{"", "the file is empty, expected JSON"},
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
