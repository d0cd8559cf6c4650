// Head-mounted displays through the real OpenXR loader, with a runtime of our own behind it: where pictures are made
// for, what is submitted, and what happens when the headset goes.

#include "display/sinks/openxr.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <glm/gtc/constants.hpp>

#include "display/render/context/context_glfw.h"
#include "display/sinks/render_display.h"
#include "tests/display/xvfb_server.h"
#include "tests/openxr_runtime/worn_card.h"

namespace dubsar {
namespace {

using testing::MadeFrame;
using testing::MadePose;

double degrees_between(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b)))) * 180.0 / glm::pi<double>();
}

class OpenXr : public testing::WornCard {};

/// Truth: where an eye is at the time that a frame is displayed.
MadePose true_eye(const testing::MadeFacts& made, const MadeFrame& frame, int eye) {
  const MadePose head = made_head(made, 1e-9 * static_cast<double>(frame.displayed));
  const double side = (eye == 0 ? -0.5 : 0.5) * made.wearer.eyes_apart_m;
  return {head.position + head.rotation * glm::dvec3(side, 0, 0), head.rotation};
}

void expect_predicted_poses(const testing::MadeFacts& made, std::size_t from) {
  ASSERT_GT(made.frames.size(), from);
  for (std::size_t i = from; i < made.frames.size(); ++i) {
    const MadeFrame& frame = made.frames[i];
    ASSERT_EQ(frame.layers, 1) << "frame " << i;
    EXPECT_EQ(frame.displayed, frame.predicted);
    for (int eye = 0; eye < 2; ++eye) {
      const MadePose truth = true_eye(made, frame, eye), given = frame.poses[static_cast<std::size_t>(eye)];
      EXPECT_LE(degrees_between(truth.rotation, given.rotation), 0.2) << "frame " << i << ", eye " << eye;
      EXPECT_LE(glm::distance(truth.position, given.position), 1e-3) << "frame " << i << ", eye " << eye;
    }
  }
}

TEST_F(OpenXr, LayersHaveThePosesPredictedForTheDisplayTimeWhileTheHeadTurns) {
  made_->wearer.yaw_amplitude = 0.5;  // up to 126 degrees a second: 1.4 from one frame to the next
  made_->wearer.nod_amplitude = 0.2;
  made_->wearer.sway_m = 0.05;
  open();
  pictures_until_worn();
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(picture());
  EXPECT_EQ(std::string_view(made_->binding), "EGL");
  EXPECT_EQ(made_->frames.size(), 61u);
  expect_predicted_poses(*made_, 0);
}

TEST_F(OpenXr, TheLoopGoesAtTheHeadsetsOwnRate) {
  for (const double refresh_hz : {72.0, 80.0, 120.0}) {
    made_->reset();
    made_->wearer.refresh_hz = refresh_hz;
    made_->wearer.yaw_amplitude = 0.5;
    open();
    pictures_until_worn();
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(picture());
    ASSERT_EQ(made_->frames.size(), 31u) << "one picture for each that the headset waits for, at " << refresh_hz;
    for (std::size_t i = 1; i < made_->frames.size(); ++i)
      EXPECT_NEAR(static_cast<double>(made_->frames[i].displayed - made_->frames[i - 1].displayed), 1e9 / refresh_hz,
                  1.0);
    expect_predicted_poses(*made_, 0);
    scene_.reset();
    sink_.reset();
  }
}

/// Where the object stands, from the first head and the floor.
glm::dvec3 expected_place(const testing::MadeFacts& made, const MadePose& first_head) {
  glm::dvec3 ahead = first_head.rotation * glm::dvec3(0, 0, -1);
  ahead = glm::normalize(glm::dvec3(ahead.x, 0, ahead.z));
  const double steepest = first_head.position.y - 0.5 * 0.466308;  // 25 degrees under the eyes
  return {first_head.position.x + 0.5 * ahead.x, std::max(made.wearer.floor_m + 0.85, steepest),
          first_head.position.z + 0.5 * ahead.z};
}

TEST_F(OpenXr, TheObjectStaysOnItsTableInBothEyesPictures) {
  made_->wearer.yaw_amplitude = 0.25;
  made_->wearer.nod_amplitude = 0.1;
  made_->wearer.sway_m = 0.06;
  made_->wearer.yaw_middle = 1.1;  // whichever way the wearer sits
  made_->wearer.head_middle = {0.3, 0.1, -0.7};
  made_->wearer.floor_m = -1.05;  // the object's middle is 20 cm under the eyes: on its table, and not too steep
  open();
  pictures_until_worn();
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(picture());
  const MadePose first = made_head(*made_, 1e-9 * static_cast<double>(made_->frames[0].displayed));
  const glm::dvec3 place = expected_place(*made_, first);
  for (const MadeFrame& frame : made_->frames)
    for (int eye = 0; eye < 2; ++eye) {
      const MadePose at = true_eye(*made_, frame, eye);
      const glm::dvec3 seen = glm::conjugate(at.rotation) * (place - at.position);
      const auto& fov = frame.fov[static_cast<std::size_t>(eye)];
      const auto pixel = [&](double tangent, float low, float high) {
        return testing::kMadeEyePx * (tangent - std::tan(low)) / (std::tan(high) - std::tan(low));
      };
      const auto bright = frame.bright[static_cast<std::size_t>(eye)];
      ASSERT_TRUE(bright) << "nothing to be seen";
      EXPECT_NEAR(bright->x, pixel(seen.x / -seen.z, fov[0], fov[1]), 0.6);
      EXPECT_NEAR(bright->y, pixel(seen.y / -seen.z, fov[3], fov[2]), 0.6);
    }
  int lit = 0;  // and the window shows the left eye's
  const Image mirror = scene_->mirror.read().value();
  for (int y = 0; y < mirror.height; ++y)
    for (int x = 0; x < mirror.width; ++x) lit += mirror.at(x, y)[0] > 127;
  EXPECT_GT(lit, 20);
}

TEST_F(OpenXr, ALostSessionAndALostRuntimeComeBack) {
  made_->wearer.yaw_amplitude = 0.3;
  open();
  pictures_until_worn();
  for (const bool whole_runtime : {false, true}) {
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(picture());
    const Pose before = sink_->wearer()->eyes[0].pose;
    {
      const std::lock_guard lock(made_->mutex);
      (whole_runtime ? made_->faults.end_instance : made_->faults.lose_session) = true;
    }
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(picture());
    EXPECT_FALSE(sink_->note().empty());
    const std::size_t seen = made_->frames.size();
    {
      const std::lock_guard lock(made_->mutex);
      made_->faults.end_instance = made_->faults.lose_session = false;
    }
    pictures_until_worn();
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(picture());
    EXPECT_TRUE(sink_->note().empty());
    EXPECT_EQ(made_->alive.sessions, 1);
    EXPECT_EQ(made_->alive.swapchains, 2);
    expect_predicted_poses(*made_, seen);
    EXPECT_NEAR(glm::length(before.position_m), glm::length(sink_->wearer()->eyes[0].pose.position_m), 0.05)
        << "the object stands where it stood";
  }
  EXPECT_GE(made_->sessions_ever, 3);
}

TEST_F(OpenXr, TheWearersMiddleIsBeforeTheWearerAgainAfterRecentring) {
  open("openxr:distance=0.7,height=1.2");
  pictures_until_worn();
  const auto head = [&] {
    const auto wearer = sink_->wearer();
    return 0.5 * (wearer->eyes[0].pose.position_m + wearer->eyes[1].pose.position_m);
  };
  EXPECT_NEAR(head().z, 0.7, 1e-6);
  EXPECT_NEAR(head().y, 1.5 - 1.2, 1e-6) << "over the floor, which is 1.5 m under the eyes";
  EXPECT_NEAR(*sink_->wearer()->floor_m, -1.2, 1e-6);
  {
    const std::lock_guard lock(made_->mutex);
    made_->wearer.yaw_middle = 2.0;
    made_->wearer.head_middle = {1, 0, 1};
  }
  ASSERT_TRUE(picture());
  EXPECT_GT(std::abs(head().x), 0.2);
  for (const bool by_runtime : {true, false}) {
    if (by_runtime) {
      const std::lock_guard lock(made_->mutex);
      made_->faults.recentre = true;
    } else {
      const std::lock_guard lock(made_->mutex);
      made_->wearer.yaw_middle = -1.0;
      sink_->recentre();
    }
    ASSERT_TRUE(picture());
    EXPECT_NEAR(head().x, 0.0, 1e-6);
    EXPECT_NEAR(head().z, 0.7, 1e-6);
  }
}

TEST_F(OpenXr, WithoutAFloorTheObjectIsUnderTheEyes) {
  made_->wearer.has_floor = false;
  open();
  pictures_until_worn();
  EXPECT_NEAR(sink_->wearer()->eyes[0].pose.position_m.y, 0.2, 1e-6);
  EXPECT_FALSE(sink_->wearer()->floor_m);
}

TEST_F(OpenXr, WhatIsMissingIsSaidAndWaitedFor) {
  made_->faults.no_headset = true;
  EXPECT_NE(headset_facts().words.find("no headset"), std::string::npos);
  open();
  EXPECT_FALSE(picture());
  EXPECT_NE(sink_->note().find("Made Runtime 1.2.3 has no headset"), std::string::npos) << sink_->note();
  made_->faults.no_headset = false;
  pictures_until_worn();
  EXPECT_TRUE(picture());
  scene_.reset();
  sink_.reset();
  EXPECT_EQ(headset_facts().words, "runtime Made Runtime 1.2.3, headset Made Headset, hands, EGL and GLX, Vulkan");
  ::setenv("XR_RUNTIME_JSON", "/nonexistent/runtime.json", 1);
  open();
  EXPECT_FALSE(picture());
  EXPECT_EQ(sink_->note(), "openxr: no runtime answers: /nonexistent/runtime.json (XR_RUNTIME_JSON) is not there");
  ::setenv("XR_RUNTIME_JSON", DUBSAR_MADE_RUNTIME_JSON, 1);
  made_->faults.end_instance = true;
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
       sink_->note().find("start the one of") == std::string::npos; picture())
    ASSERT_LT(std::chrono::steady_clock::now(), end) << sink_->note();
  made_->faults.end_instance = false;
  EXPECT_EQ(SinkCatalog().make("openxr:far").error().kind, ErrorKind::kUsage);
  EXPECT_EQ(SinkCatalog().make("openxr:blend=half").error().kind, ErrorKind::kUsage);
  SilentProgress progress;
  EXPECT_EQ(render_display(testing::lettered_box(), {"openxr"}, {}, progress).error().kind, ErrorKind::kUsage);
}

/// The same in a window on an X server: a context of GLX.
class OpenXrInWindow : public OpenXr {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<testing::XvfbServer>(); }
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    WornTest::SetUp();  // NOLINT(bugprone-parent-virtual-call): OpenXr makes a context of EGL, this one is of GLX
    if (!server_->problem().empty()) GTEST_SKIP() << server_->problem();
    WindowOptions options;
    options.width = 320;
    options.height = 200;
    auto window = GlfwWindow::create(options);
    ASSERT_TRUE(window) << window.error().message;
    window_ = std::move(*window);
  }
  void TearDown() override {
    OpenXr::TearDown();
    window_.reset();
  }
  inline static std::unique_ptr<testing::XvfbServer> server_;
  std::unique_ptr<GlfwWindow> window_;
};

TEST_F(OpenXrInWindow, AContextOfGlxIsBoundAndShowsTheSame) {
  made_->wearer.yaw_amplitude = 0.5;
  made_->wearer.floor_m = -1.05;
  open();
  pictures_until_worn();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(picture());
  EXPECT_EQ(std::string_view(made_->binding), "GLX");
  expect_predicted_poses(*made_, 0);
  for (const MadeFrame& frame : made_->frames)
    for (const auto& bright : frame.bright) EXPECT_TRUE(bright);
}

TEST(RoomFromScreen, IsNoSteeperThan25DegreesUnderTheEyesOfWhoStands) {
  for (const double eyes : {0.9, 1.1, 1.2, 1.5, 1.6, 1.9}) {
    const Pose room = room_from_screen({{0, eyes, 0}, {1, 0, 0, 0}}, 0.0, {});
    const double down_deg = std::atan2(eyes - room.position_m.y, 0.5) * 180.0 / glm::pi<double>();
    EXPECT_LE(down_deg, 25.0 + 1e-9) << eyes;
    EXPECT_GE(room.position_m.y, 0.85) << "never under the table";
  }
}

TEST(RoomFromScreen, IsBeforeTheEyesWhicheverWayTheyLook) {
  const HeadsetPlace place{.steepest_deg = 80.0};
  for (const double yaw : {0.0, 1.0, 3.0, -2.0})
    for (const double nod : {0.0, -1.0, 1.0, -1.5, 1.5}) {
      const Pose head{{0.2, 1.6, -0.4},
                      glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) * glm::angleAxis(nod, glm::dvec3(1, 0, 0))};
      const Pose room = room_from_screen(head, 0.0, place);
      const glm::dvec3 ahead(-std::sin(yaw), 0, -std::cos(yaw));
      EXPECT_LE(glm::distance(room.position_m, glm::dvec3(0.2, 0.85, -0.4) + 0.5 * ahead), 1e-9) << yaw << " " << nod;
      EXPECT_LE(glm::distance(room.rotation * glm::dvec3(0, 0, 1), -ahead), 1e-9) << "towards the wearer";
      EXPECT_LE(glm::distance(room.rotation * glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 0)), 1e-9);
    }
}

TEST(PanelBefore, IsWhereBothEyesFieldsEndAtTheSameEdges) {
  const Pose panel{{0.4, 1.1, -0.7}, glm::angleAxis(0.6, glm::normalize(glm::dvec3(0.2, 1.0, -0.1)))};
  const double half_w = 0.172, half_h = 0.097;
  for (const glm::dvec3& middle : {glm::dvec3(0, 0.1, 0.6), glm::dvec3(-0.2, -0.05, 0.4), glm::dvec3(0.3, 0, 1.2)}) {
    std::array<HeadsetEye, 2> eyes;
    for (const int eye : {0, 1}) {
      const glm::dvec3 at = middle + glm::dvec3(eye == 0 ? -0.03 : 0.03, 0, 0);
      eyes[static_cast<std::size_t>(eye)] = {{panel.position_m + panel.rotation * at, panel.rotation},
                                             (-half_w - at.x) / at.z,
                                             (half_w - at.x) / at.z,
                                             (-half_h - at.y) / at.z,
                                             (half_h - at.y) / at.z};
    }
    const auto found = panel_before(eyes);
    ASSERT_TRUE(found);
    EXPECT_LE(glm::distance(found->position_m, panel.position_m), 1e-9);
    EXPECT_LE(degrees_between(found->rotation, panel.rotation), 1e-5);
  }
}

TEST(PanelBefore, IsNoneForFieldsOfHeadsets) {
  const Pose at{{-0.032, 1.6, 0}, {1, 0, 0, 0}}, other{{0.032, 1.6, 0}, {1, 0, 0, 0}};
  EXPECT_FALSE(panel_before({HeadsetEye{at, -1, 1, -1, 1}, HeadsetEye{other, -1, 1, -1, 1}})) << "the same for both";
  EXPECT_FALSE(panel_before({HeadsetEye{at, -1.2, 0.9, -1, 1}, HeadsetEye{other, -0.9, 1.2, -1, 1}}))
      << "wider outside";
  EXPECT_FALSE(panel_before({HeadsetEye{at, -0.9, 1.1, -1, 1}, HeadsetEye{other, -1.0, 0.8, -1, 1}}))
      << "edges at two distances";
  Pose canted = other;
  canted.rotation = glm::angleAxis(0.1, glm::dvec3(0, 1, 0));
  EXPECT_FALSE(panel_before({HeadsetEye{at, -1, 1.05, -1, 1}, HeadsetEye{canted, -1.05, 1, -1, 1}}));
}

}  // namespace
}  // namespace dubsar
