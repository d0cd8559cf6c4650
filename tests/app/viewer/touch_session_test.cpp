// Fingers on a simulated touch panel in whole sessions: what they touch follows them, on every display.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/stage/pick_camera.h"
#include "app/viewer/run_view.h"
#include "app/viewer/viewer.h"
#include "devices/touch/simulated_touch.h"
#include "input/input_recording.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"

namespace dubsar::app {
namespace {

using Fingers = std::map<std::uint32_t, glm::dvec2>;

class TouchSession : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.mapping = default_mapping().value();
    options_.stage.shading = shading_preset("relief").value();
    options_.stage.display = testing::spec("mono");
    options_.stage.screen = {344, 194, 960, 540, 0, 0, 960, 540};
    options_.time.fps = 60.0;
    options_.time.longest_s = 30.0;
    options_.around.notices = false;
    options_.inputs = {"touch"};
    options_.sources.make = [this](std::string_view spec, const InputConfig& config) {
      InputConfig with = config;
      with.reach_device = [this](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
        return OpenTransport([this] { return panel_.device().open(); });
      };
      return make_input(spec, with);
    };
  }
  /// `act` is asked at each step for the fingers that are on the glass; none: it is over.
  Result<ViewResult> play(const std::function<std::optional<Fingers>(int step, const ViewMoment&)>& act) {
    int step = 0;
    return run_view(testing::lettered_box(), options_, progress_, [&](const ViewMoment& moment) {
      const auto fingers = act(step, moment);
      if (!fingers) return moment.presenter.end();
      panel_.touch(1'000'000'000 + 16'000'000LL * step, *fingers);
      ++step;
    });
  }
  /// Shares of the panel of a place of the window, which covers it.
  static glm::dvec2 share(const glm::dvec2& at) { return {0.5 + at.x * 540 / 960, 0.5 - at.y}; }
  static std::optional<glm::dvec3> surface_at(const ViewMoment& moment, const glm::dvec2& at) {
    const Viewer& viewer = moment.viewer;
    const auto picked = Picker(viewer.mesh()).pick(PartLooks(), PickCamera::of(viewer.stage()).ray(at));
    return picked ? std::optional(picked->at_mm) : std::nullopt;
  }

  TouchPanelSim panel_;
  ViewOptions options_;
  SilentProgress progress_;
};

TEST_F(TouchSession, WhatOneFingerTakesFollowsIt) {
  std::optional<glm::dvec3> held;
  double worst = 0.0;
  const auto done = play([&](int step, const ViewMoment& moment) -> std::optional<Fingers> {
    const glm::dvec2 from(0.12, 0.06), to(-0.05, -0.03);  // so that the ball on which it goes has a place for it
    if (step == 0) held = surface_at(moment, from);
    if (step < 3) return Fingers{};
    const glm::dvec2 at = glm::mix(from, to, std::clamp((step - 10) / 40.0, 0.0, 1.0));
    if (step > 70) worst = std::max(worst, glm::distance(PickCamera::of(moment.viewer.stage()).seen(*held), to));
    if (step > 80) return std::nullopt;
    return Fingers{{1, share(at)}};
  });
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_TRUE(held);
  EXPECT_GT(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 5.0);
  EXPECT_LT(worst, 0.004) << "heights of the window: two of the 540 pixels";
}

class TouchDisplays : public TouchSession, public ::testing::WithParamInterface<const char*> {};

TEST_P(TouchDisplays, WhatTwoFingersTakeStaysBetweenThemAndAFingerThatGoesMovesNothing) {
  options_.stage.display = testing::spec(GetParam());
  std::optional<glm::dvec3> held;
  ViewState before{};
  double apart = 1.0;
  const auto done = play([&](int step, const ViewMoment& moment) -> std::optional<Fingers> {
    const glm::dvec2 from(0.03, -0.02), to(0.1, 0.06);
    if (step == 0) held = surface_at(moment, from);
    if (step < 3) return Fingers{};
    const double t = std::clamp((step - 10) / 40.0, 0.0, 1.0), angle = 0.5 * t, arm = 0.1 + 0.08 * t;
    const glm::dvec2 middle = glm::mix(from, to, t), by = arm * glm::dvec2(std::cos(angle), std::sin(angle));
    if (step == 70) {
      before = moment.report.view;
      apart = glm::distance(PickCamera::of(moment.viewer.stage()).seen(*held), to);
    }
    if (step > 100) return std::nullopt;
    if (step > 85) return Fingers{};
    if (step > 70) return Fingers{{1, share(middle + by)}};
    return Fingers{{1, share(middle + by)}, {2, share(middle - by)}};
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_NEAR(before.zoom, 1.8, 0.01);
  EXPECT_LT(turn_between_deg(before.rotation, turn_of({0, 0, 0.5})), 0.2);
  EXPECT_LT(apart, 0.004) << "heights of the window: two of the 540 pixels";
  EXPECT_EQ(done->view.rotation, before.rotation);
  EXPECT_EQ(done->view.zoom, before.zoom);
  EXPECT_EQ(done->view.pan, before.pan);
}

INSTANTIATE_TEST_SUITE_P(Touch, TouchDisplays,
                         ::testing::Values("mono", "anaglyph",
                                           "quilt:columns=2,rows=1,width=1920,height=540,aspect=1.777,cone=40"),
                         [](const auto& display) {
                           const std::string spec = display.param;
                           return spec.substr(0, spec.find(':'));
                         });

TEST_F(TouchSession, TheRecordingPlaysWhatTheFingersDidWithoutAPanel) {
  const auto path =
      std::filesystem::temp_directory_path() / ("dubsar_fingers_" + std::to_string(::getpid()) + ".jsonl");
  options_.files.record = path;
  const auto fingers = [&](int step, const ViewMoment&) -> std::optional<Fingers> {
    if (step > 90) return std::nullopt;
    if (step < 3 || step > 80) return Fingers{};
    if (step < 40) return Fingers{{1, share({0.002 * step, 0.02})}};
    return Fingers{{1, share({0.1, 0.02})}, {2, share({-0.1, 0.004 * (step - 40)})}};
  };
  const auto live = play(fingers);
  ASSERT_TRUE(live) << live.error().message;
  EXPECT_GT(turn_between_deg(live->view.rotation, {1, 0, 0, 0}), 5.0);
  options_.files.record.clear();
  options_.inputs = {"replay:" + path.string()};
  options_.sources.make = make_input;
  const auto again = run_view(testing::lettered_box(), options_, progress_);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_LT(turn_between_deg(again->view.rotation, live->view.rotation), 1e-3);
  EXPECT_NEAR(again->view.zoom, live->view.zoom, 1e-6);
  EXPECT_LT(glm::distance(again->view.pan, live->view.pan), 1e-6);
  std::filesystem::remove(path);
}

TEST_F(TouchSession, WithAToolInTheHandATapIsAClickAndWhatTwoFingersOrTheCableEndIsNone) {
  options_.steps = {{0.0, "tool distance"}};
  const auto done = play([&](int step, const ViewMoment&) -> std::optional<Fingers> {
    const auto within = [&](int from, int to) { return step >= from && step < to; };
    if (step > 200) return std::nullopt;
    if (within(10, 15)) return Fingers{{1, share({0.05, 0.0})}};                          // a tap
    if (within(40, 60)) return Fingers{{2, share({0.0, 0.0})}};                           // one finger rests,
    if (within(60, 80)) return Fingers{{2, share({0.0, 0.0})}, {3, share({0.05, 0.0})}};  // another comes
    if (within(100, 120)) return Fingers{{4, share({0.0, 0.0})}};                         // and one whose
    if (step == 120) panel_.device().unplug();                                            // panel goes
    if (step == 121) panel_.touch(5'000'000'000, {});
    if (step == 122) panel_.device().plug();
    if (within(180, 190)) return Fingers{{5, share({-0.05, 0.0})}};  // the second tap
    return Fingers{};
  });
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(done->document.measures.size(), 1U) << "two taps; of four clicks there would be two";
  EXPECT_LT(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 1e-9);
}

TEST_F(TouchSession, UnpluggedInTheMiddleNothingIsHeldAndItGoesOnAfterwards) {
  std::vector<ViewState> views;
  const auto done = play([&](int step, const ViewMoment& moment) -> std::optional<Fingers> {
    views.push_back(moment.report.view);
    if (step == 30) panel_.device().unplug();
    if (step == 60) {
      panel_.touch(2'000'000'000, {});
      panel_.device().plug();
    }
    if (step > 200) return std::nullopt;
    if (step > 120) return Fingers{{2, share({-0.002 * (step - 120), 0.0})}};
    if (step > 50) return Fingers{};
    return Fingers{{1, share({0.003 * step, 0.0})}};
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(turn_between_deg(views[30].rotation, views[0].rotation), 3.0);
  EXPECT_EQ(views[119].rotation, views[40].rotation);
  EXPECT_GT(turn_between_deg(views[200].rotation, views[119].rotation), 3.0);
}

}  // namespace
}  // namespace dubsar::app
