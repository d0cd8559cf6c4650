// The three people of the documentation's strips, on a small object and small displays.

#include "tests/app/viewer/scripted_sessions.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/base/files/atomic_file.h"
#include "input/simulated/script.h"
#include "tests/display/test_meshes.h"

namespace dubsar::testing {
namespace {

namespace fs = std::filesystem;
constexpr double kRad = std::numbers::pi / 180.0;

class ScriptedSession : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<XvfbServer>(640, 480); }
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    if (!server_->problem().empty()) GTEST_SKIP() << server_->problem();
    folder_ = fs::temp_directory_path() / ("dubsar_scripted_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "panels");
    // A piece of a tracked panel: the lenses of the 15.6" one.
    std::ofstream(folder_ / "panels/panel.json")
        << R"([{"name": "piece", "title": "test", "kind": "tracked", "width_px": 480,
        "height_px": 270, "width_mm": 43.2, "optics": {"pitch_mm": 0.200884, "tan_slant": 0.333333, "reduced_gap_mm": 0.956589,
        "refractive_index": 1.5, "phase0": 0.0, "spot_sigma_periods": 0.1}, "design_distance_mm": 600, "ipd_mm": 63}])";
  }
  void TearDown() override { fs::remove_all(folder_); }
  static std::string script(const char* name) { return std::string(DUBSAR_SCRIPTS) + "/" + name; }
  static Script parsed(const char* name) { return parse_script(read_text_file(script(name)).value(), name).value(); }

  inline static std::unique_ptr<XvfbServer> server_;
  fs::path folder_;
};

double differing_share(const Image& a, const Image& b) {
  if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 1.0;
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) differ += std::abs(a.pixels[i] - b.pixels[i]) > 8;
  return static_cast<double>(differ) / static_cast<double>(a.pixels.size());
}

/// Share of pixels that are much brighter than the background.
double lit_share(const Image& image) {
  std::size_t lit = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) lit += image.pixels[i] > 70;
  return 3.0 * static_cast<double>(lit) / static_cast<double>(image.pixels.size());
}

TEST_F(ScriptedSession, AVisitorsHandsTurnAndZoomTheTabletOnAQuilt) {
  const Stage stage{.display = "quilt:columns=4,rows=2,width=384,height=192,aspect=1,cone=40",
                    .width = 384,
                    .height = 192,
                    .every = 60};
  const auto session = play(*server_, lettered_box(), stage, {"scripted:" + script("visitor.json")});
  ASSERT_TRUE(session) << session.error().message;
  const Script wanted = parsed("visitor.json");
  EXPECT_LE(turn_between_deg(session->result.view.rotation, turn_of({wanted.visitor->pitch_deg * kRad, 0, 0}) *
                                                                turn_of({0, wanted.visitor->yaw_deg * kRad, 0})),
            5.0);
  EXPECT_NEAR(session->result.view.zoom, wanted.visitor->zoom, 0.05 * wanted.visitor->zoom);
  EXPECT_LE(session->result.largest_turn_deg, 2.0);
  ASSERT_GT(session->moments.size(), 5u);
  for (const SessionMoment& moment : session->moments)
    for (int tile = 0; tile < 8; ++tile)
      EXPECT_GT(lit_share(quilt_tile(moment.window, 4, 2, tile)), 0.1) << "a blank view at " << moment.time_s << " s";
  const Image& last = session->moments.back().window;
  EXPECT_GT(differing_share(session->moments.front().window, last), 0.1);
  EXPECT_GT(differing_share(quilt_tile(last, 4, 2, 0), quilt_tile(last, 4, 2, 7)), 0.03)
      << "views from left and right differ";
}

TEST_F(ScriptedSession, AScholarsHeadMovesBeforeAWeavedPanelAndEachEyeSeesItsOwnView) {
  const Stage stage{.display = "lenticular:piece",
                    .width = 480,
                    .height = 270,
                    .every = 84,
                    .longest_s = 4.8,
                    .panel_folder = folder_ / "panels"};
  const auto session = play(*server_, lettered_box(), stage, {"scripted:" + script("scholar.json")});
  ASSERT_TRUE(session) << session.error().message;
  const Script wanted = parsed("scholar.json");
  Image first_left;
  int checked = 0;
  for (const SessionMoment& moment : session->moments) {
    const auto head = sample_head(wanted.heads[0], moment.time_s);
    if (moment.time_s < 0.5 || !head) continue;
    ASSERT_EQ(moment.report.head, Presence::kTracked);
    const auto seen = seen_from(moment, 1e3 * *head);
    ASSERT_TRUE(seen) << seen.error().message;
    EXPECT_EQ(seen->left_light.main_view, 0) << moment.time_s;
    EXPECT_EQ(seen->right_light.main_view, 1) << moment.time_s;
    EXPECT_LE(std::max(seen->left_light.crosstalk, seen->right_light.crosstalk), 0.05) << moment.time_s;
    EXPECT_GT(lit_share(seen->left), 0.1);
    EXPECT_GT(differing_share(seen->left, seen->right), 0.005) << "two eyes, two pictures";
    if (first_left.pixels.empty()) first_left = seen->left;
    if (moment.time_s > 3.9) {
      EXPECT_GT(differing_share(first_left, seen->left), 0.02) << "the head went from left to right";
    }
    ++checked;
  }
  EXPECT_EQ(checked, 3);
}

TEST_F(ScriptedSession, ADeveloperGetsTheSameFromSimulatedDevicesAndFromTheirRecording) {
  const Stage stage{.display = "lenticular:piece",
                    .width = 480,
                    .height = 270,
                    .every = 30,
                    .longest_s = 5.9,
                    .panel_folder = folder_ / "panels"};
  const fs::path recording = folder_ / "developer.jsonl";
  const auto live =
      play(*server_, lettered_box(), stage,
           {"spacemouse:simulate=" + script("developer.json"), "head:opentrack,simulate=" + script("developer.json")},
           recording);
  ASSERT_TRUE(live) << live.error().message;
  EXPECT_GT(turn_between_deg(live->result.view.rotation, {1, 0, 0, 0}) + std::abs(live->result.view.zoom - 1.0) * 100,
            10.0);
  const auto replayed = play(*server_, lettered_box(), stage, {"replay:" + recording.string()});
  ASSERT_TRUE(replayed) << replayed.error().message;
  EXPECT_LT(turn_between_deg(live->result.view.rotation, replayed->result.view.rotation), 0.2);
  EXPECT_NEAR(live->result.view.zoom, replayed->result.view.zoom, 0.002);
  ASSERT_EQ(live->moments.size(), replayed->moments.size());
  int tracked = 0;
  for (std::size_t i = 0; i < live->moments.size(); ++i) {
    const glm::dvec3 apart =
        live->moments[i].report.viewer.centre_mm() - replayed->moments[i].report.viewer.centre_mm();
    EXPECT_LT(glm::length(apart), 3.0) << live->moments[i].time_s;
    EXPECT_LT(differing_share(live->moments[i].window, replayed->moments[i].window), 0.05) << live->moments[i].time_s;
    tracked += live->moments[i].report.head == Presence::kTracked;
  }
  EXPECT_GE(tracked, 8);
}

}  // namespace
}  // namespace dubsar::testing
