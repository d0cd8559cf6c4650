// Several panels of one session, without windows.

#include "app/viewer/side_panels.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/viewer/run_view.h"
#include "core/image_io/png_file.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr const char* kHand = R"({"seed": 3, "duration_s": 3, "rate_hz": 60, "hands": [{"chirality": "right", "keys": [
  {"t": 0.2, "at_mm": [0, 0, 150]}, {"t": 0.9, "at_mm": [0, 0, 150]}, {"t": 1.1, "grab": 1},
  {"t": 2.0, "at_mm": [90, 20, 150], "grab": 1}]}]})";

class SidePanelsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dubsar_panels_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "hand.json") << kHand;
  }
  void TearDown() override { fs::remove_all(folder_); }
  ViewOptions session(const std::string& display, int width, int height, const std::string& pictures) const {
    ViewOptions out;
    out.mapping = default_mapping().value();
    out.stage.shading = shading_preset("relief").value();
    out.stage.display = testing::spec(display);
    out.stage.screen = screen(width, height);
    out.inputs = {"scripted:path=" + (folder_ / "hand.json").string()};
    out.time.fps = 20.0;
    out.around.notices = false;
    out.files.frames = folder_ / pictures;
    out.files.every = 10;
    return out;
  }
  static Screen screen(int width, int height) {
    Screen out;
    out.width_px = out.window_w = width;
    out.height_px = out.window_h = height;
    out.height_mm = out.width_mm * height / width;
    return out;
  }
  static SidePanelOptions panel(const std::string& display, int width, int height) {
    SidePanelOptions out;
    out.name = display;
    out.display = testing::spec(display);
    out.screen = screen(width, height);
    return out;
  }
  Image picture(const std::string& file) const {
    auto read = read_png((folder_ / file).string());
    EXPECT_TRUE(read) << file;
    return read ? *std::move(read) : Image();
  }

  fs::path folder_;
  SilentProgress progress_;
};

TEST_F(SidePanelsTest, EachShowsWhatASessionOfItsOwnWouldShow) {
  ViewOptions together = session("mono", 240, 180, "together");
  together.also = {panel("anaglyph", 200, 160),
                   panel("quilt:columns=3,rows=2,width=300,height=200,aspect=1,cone=40", 300, 200)};
  const auto done = run_view(testing::lettered_box(), together, progress_);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 10.0) << "else nothing moves";
  ASSERT_EQ(done->also.size(), 2U);
  for (const PanelOutcome& one : done->also) {
    EXPECT_TRUE(one.trouble.empty()) << one.trouble;
    EXPECT_GE(one.frames, 5);
  }
  for (const auto& [number, options] : {std::pair{0, session("mono", 240, 180, "alone0")},
                                        {1, session("anaglyph", 200, 160, "alone1")},
                                        {2, session(together.also[1].name, 300, 200, "alone2")}}) {
    ASSERT_TRUE(run_view(testing::lettered_box(), options, progress_));
    int compared = 0;
    for (const auto& file : fs::directory_iterator(options.files.frames)) {
      const std::string name = file.path().filename().string(), at = name.substr(0, 11), rest = name.substr(11);
      const std::string here = number == 0 ? at + rest : at + fmt::format("-{}", number + 1) + rest;
      EXPECT_EQ(picture("together/" + here).pixels, picture(fmt::format("alone{}/{}", number, name)).pixels) << here;
      ++compared;
    }
    EXPECT_GE(compared, 5);
  }
}

TEST_F(SidePanelsTest, OneThatCannotBeShownIsSaidAndTheOthersGoOn) {
  ViewOptions options = session("mono", 160, 120, "some");
  options.also = {panel("mono", 100, 80), panel("anaglyph", 100, 80)};
  options.also[0].problem = "no such thing";
  std::string said;
  const auto done = run_view(testing::lettered_box(), options, progress_);
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(done->also.size(), 2U);
  EXPECT_EQ(done->also[0].trouble, "no such thing");
  EXPECT_EQ(done->also[0].frames, 0);
  EXPECT_TRUE(done->also[1].trouble.empty());
  EXPECT_GT(done->also[1].frames, 3);
  EXPECT_TRUE(fs::exists(folder_ / "some/frame-00010-3.png"));
  EXPECT_FALSE(fs::exists(folder_ / "some/frame-00010-2.png"));
}

TEST(ShownOn, WhatStandsAboutTheObjectKeepsItsPlaceAtIt) {
  Shown main;
  main.before.push_back({{{30, 0, 5}, {130, 40, 5}}, 3.0});
  main.glow = {{30, 0, 0}, 20.0, 0.5};
  const PanelPlane wide{{600, 300}, {0, 0}, 1000, nullptr}, narrow{{100, 200}, {10, 20}, 500, nullptr};
  const Shown here = shown_on(main, wide, narrow);
  // The object is as large as the shorter side has room for: here it is a third of what it is there.
  EXPECT_NEAR(glm::distance(here.before[0].points_mm[0], glm::dvec3(20, 20, 5.0 / 3)), 0.0, 1e-9);
  EXPECT_NEAR(glm::distance(here.before[0].points_mm[1], glm::dvec3(10 + 130.0 / 3, 20 + 40.0 / 3, 5.0 / 3)), 0, 1e-9);
  EXPECT_NEAR(here.before[0].width_px, 1.5, 1e-9);
  EXPECT_NEAR(glm::distance(here.glow.at_mm, glm::dvec3(20, 20, 0)), 0.0, 1e-9);
  EXPECT_NEAR(here.glow.radius_mm, 20.0 / 3, 1e-9);
  EXPECT_EQ(here.glow.strength, 0.5);
}

}  // namespace
}  // namespace dubsar::app
