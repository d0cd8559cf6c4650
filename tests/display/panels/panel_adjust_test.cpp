// What the user found by eye is kept, applied everywhere, and refused by name and range.

#include "display/panels/panel_adjust.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/files/atomic_file.h"
#include "display/panels/panel_calibration.h"
#include "display/sinks/catalog/sink_catalog.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class PanelAdjust : public ::testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  PanelProfile panel(std::string_view name) const { return load_panels(folder_ / "panels").find(name).value(); }
  fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_adjust_{}", ::getpid());
};

constexpr const char* kGo = "looking-glass-go";

TEST_F(PanelAdjust, SavedFiguresReplaceThoseOfTheProfileAndAddUp) {
  const fs::path panels = folder_ / "panels";
  const LookingGlassFigures before = *panel(kGo).sheet;
  ASSERT_TRUE(save_adjustment(panels, kGo, *parse_adjustment("pitch=80.74")));
  ASSERT_TRUE(save_adjustment(panels, kGo, *parse_adjustment("center=-0.31,pitch=80.75")));
  const LookingGlassFigures after = *panel(kGo).sheet;
  EXPECT_EQ(after.pitch, 80.75);
  EXPECT_EQ(after.center, -0.31);
  EXPECT_EQ(after.slope, before.slope);
  EXPECT_EQ(panel("looking-glass-portrait").sheet->pitch, 52.0) << "another panel stays as it is";
  EXPECT_TRUE(*remove_adjustment(panels, kGo));
  EXPECT_FALSE(*remove_adjustment(panels, kGo));
  EXPECT_EQ(panel(kGo).sheet->pitch, before.pitch);
}

TEST_F(PanelAdjust, ACalibrationIsAdjustedToo) {
  const fs::path panels = folder_ / "panels";
  ASSERT_TRUE(save_adjustment(panels, kGo, *parse_adjustment("slope=-6.5")));
  const auto calibration = parse_calibration(
      R"({"serial": "LKG-E1", "pitch": 80.1, "slope": -6.6, "center": 0.25, "DPI": 491, "screenW": 1440, "screenH": 2560})",
      "v");
  const auto profile = calibrated_profile(load_panels(panels), *calibration);
  ASSERT_TRUE(profile);
  EXPECT_EQ(profile->sheet->slope, -6.5);
  EXPECT_EQ(profile->sheet->pitch, 80.1);
  EXPECT_EQ(profile->sheet->center, 0.25);
}

TEST_F(PanelAdjust, TrackedPanelsTakeTheSameWords) {
  const fs::path panels = folder_ / "panels";
  ASSERT_TRUE(save_adjustment(panels, "spatiallabs-15.6", *parse_adjustment("pitch=0.2009,slope=0.33,center=0.125")));
  const LensOptics lens = *panel("spatiallabs-15.6").optics;
  EXPECT_EQ(lens.pitch_mm, 0.2009);
  EXPECT_EQ(lens.tan_slant, 0.33);
  EXPECT_EQ(lens.phase0, 0.125);
}

TEST_F(PanelAdjust, ImpossibleFiguresAreRefusedAndNothingIsWritten) {
  const fs::path panels = folder_ / "panels";
  const auto words = [&](const char* name, const char* text) {
    const auto adjustment = parse_adjustment(text);
    EXPECT_TRUE(adjustment) << text;
    const auto saved = save_adjustment(panels, name, *adjustment);
    EXPECT_FALSE(saved) << text;
    return saved ? std::string() : saved.error().message;
  };
  EXPECT_NE(words(kGo, "pitch=0.5").find("pitch is 0.5, expected 5 to 500"), std::string::npos);
  EXPECT_NE(words(kGo, "slope=0").find("slope is 0"), std::string::npos);
  EXPECT_NE(words("spatiallabs-15.6", "pitch=52").find("pitch is 52, expected 0.01 to 10"), std::string::npos);
  EXPECT_NE(words("looking-glass-65", "pitch=52").find("no lens figures"), std::string::npos);
  EXPECT_NE(words("no-such-panel", "pitch=52").find("no-such-panel"), std::string::npos);
  EXPECT_FALSE(fs::exists(panels));
  for (const char* text : {"", "pitch", "pitch=", "pitch=a", "pitch=1x", "pitch=1,pitch=2", "tilt=1", "pitch=1,,",
                           "center=1e999", "center=nan", "center=inf", "pitch= 1"}) {
    const auto read = parse_adjustment(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().kind, ErrorKind::kUsage);
  }
}

TEST_F(PanelAdjust, ADamagedFileLosesItsPanelWithTheReasonAndResetHealsIt) {
  const fs::path panels = folder_ / "panels";
  fs::create_directories(panels);
  const fs::path file = panels / "looking-glass-go.adjust.json";
  for (const std::string& text : {std::string(R"({"adjusts": "looking-glass-go", "pitch": "fast"})"),
                                  std::string(R"({"adjusts": "looking-glass-go", "pitch": 1e4})"), std::string("[1]"),
                                  std::string("{"), std::string(), std::string(70000, ' ')}) {
    ASSERT_TRUE(write_file_atomically(file, text));
    const PanelSet set = load_panels(panels);
    ASSERT_EQ(set.problems.size(), 1u) << text.substr(0, 80);
    EXPECT_EQ(set.problems[0].file, file);
    const auto lost = set.find(kGo);
    ASSERT_FALSE(lost) << "its figures are not guessed";
    EXPECT_EQ(lost.error().kind, ErrorKind::kConfig);
    EXPECT_NE(lost.error().message.find("looking-glass-go.adjust.json"), std::string::npos) << lost.error().message;
    EXPECT_TRUE(set.find("looking-glass-portrait")) << "its neighbours stay";
    EXPECT_EQ(save_adjustment(panels, kGo, *parse_adjustment("center=0.1")).error().kind, ErrorKind::kConfig);
    const auto removed = remove_adjustment(panels, kGo);
    ASSERT_TRUE(removed) << removed.error().message;
    EXPECT_TRUE(*removed);
    EXPECT_TRUE(load_panels(panels).find(kGo));
  }
  ASSERT_TRUE(write_file_atomically(panels / "gone.adjust.json", R"({"adjusts": "gone", "pitch": 50})"));
  EXPECT_NE(load_panels(panels).problems.at(0).reason.find("no panel is called \"gone\""), std::string::npos);
  EXPECT_TRUE(*remove_adjustment(panels, "gone"));
  EXPECT_EQ(remove_adjustment(panels, "gone").error().kind, ErrorKind::kUsage);
}

TEST_F(PanelAdjust, NamesDoNotLeadOutOfTheFolder) {
  const fs::path panels = folder_ / "panels", outside = folder_ / "x.adjust.json";
  fs::create_directories(panels);
  ASSERT_TRUE(write_file_atomically(outside, "{}"));
  EXPECT_FALSE(remove_adjustment(panels, "../x"));
  EXPECT_TRUE(fs::exists(outside));
}

TEST_F(PanelAdjust, ACalibrationCanBeJoinedWithANamedModel) {
  fs::create_directories(folder_);
  const fs::path file = folder_ / "visual.json";
  ASSERT_TRUE(write_file_atomically(
      file, R"({"serial": "X", "pitch": 48, "slope": -6, "DPI": 136, "screenW": 7680, "screenH": 4320})"));
  const auto named = choose_panel(built_in_panels(), "looking-glass-65", file);
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(named->name, "looking-glass-65");
  EXPECT_EQ(named->sheet->pitch, 48);
  EXPECT_TRUE(SinkCatalog().make(fmt::format("lenticular:panel=looking-glass-65,calibration={}", file.string())));
  EXPECT_TRUE(SinkCatalog().make(fmt::format("quilt:calibration={},looking-glass-65", file.string())));
  EXPECT_FALSE(SinkCatalog().make("lenticular:looking-glass-65")) << "it has no lens figures of its own";
  EXPECT_FALSE(choose_panel(built_in_panels(), "spatiallabs-15.6", file)) << "a tracked panel has no such calibration";
}

}  // namespace
}  // namespace dubsar
