// A whole session on a head: the wearer looks around and turns the tablet with a hand, in the made OpenXR runtime.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/steering/worn_input.h"
#include "app/viewer/run_view.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"
#include "tests/openxr_runtime/worn_test.h"

namespace dubsar::app {
namespace {

class WornSession : public dubsar::testing::WornTest {
 protected:
  void SetUp() override {
    WornTest::SetUp();
    if (HasFatalFailure()) return;
    made_->wearer.floor_m = -1.2;  // the object is 35 cm under the eyes
    made_->read_pictures = false;
    options_.mapping = default_mapping().value();
    options_.stage.shading = shading_preset("relief").value();
    options_.stage.display = dubsar::testing::spec("openxr");
    options_.stage.screen = {.width_px = 160, .height_px = 120, .window_w = 160, .window_h = 120};
    options_.inputs = {"openxr"};
    options_.time.fps = 30.0;
    options_.around.notices = false;
  }
  double now_s() const { return made_->now_s; }
  ViewOptions options_;
  SilentProgress progress_;
};

TEST_F(WornSession, AFistWithinReachTakesTheTabletAlongAndTheHeadLooksAround) {
  made_->wearer.yaw_amplitude = 0.3;
  made_->hands.right_hand = made_->hands.fist = true;
  made_->hands.hand_from = {-0.08, -0.2, -0.45};
  made_->hands.hand_speed = {0.15, 0, 0.05};  // of the runtime's time, in which a step of the session takes 11 ms
  made_->hands.hold_from = now_s() + 0.5;
  made_->hands.hold_to = now_s() + 1.5;
  options_.time.longest_s = 7.0;
  const auto done = run_view(dubsar::testing::lettered_box(), options_, progress_);
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(done->rows.size(), 1u);
  EXPECT_EQ(done->rows[0].health, SourceHealth::kPresent) << done->rows[0].reason;
  // 15 cm and 5 cm in the runtime's room, less what the hand goes before its fist is seen: window heights of 30 cm.
  EXPECT_NEAR(std::hypot(done->view.pan.x, done->view.nearer), std::hypot(0.15, 0.05) / 0.3, 0.01);
  EXPECT_NEAR(done->view.pan.y, 0.0, 1e-6);
  EXPECT_LT(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 0.01) << "a hand that does not turn turns nothing";
  ASSERT_GT(made_->frames.size(), 150u);
  for (const auto& frame : made_->frames) {
    ASSERT_EQ(frame.layers, 1);
    const auto head = made_head(*made_, 1e-9 * static_cast<double>(frame.displayed));
    for (const auto& pose : frame.poses) {
      const double turn = 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(head.rotation, pose.rotation))));
      ASSERT_LE(turn * 180.0 / std::numbers::pi, 0.2);
      ASSERT_NEAR(glm::distance(head.position, pose.position), 0.032, 1e-3);
    }
  }
}

/// What a frame shows an eye otherwise than another does, pixels from the lower left.
struct Changed {
  int left = testing::kMadeEyePx, right = 0, bottom = testing::kMadeEyePx, top = 0;
};
Changed changed(const std::vector<std::uint8_t>& from, const std::vector<std::uint8_t>& to) {
  Changed out;
  for (int y = 0; y < testing::kMadeEyePx; ++y)
    for (int x = 0; x < testing::kMadeEyePx; ++x) {
      const auto at = static_cast<std::size_t>(y * testing::kMadeEyePx + x);
      if (from[at] == to[at]) continue;
      out = {std::min(out.left, x), std::max(out.right, x + 1), std::min(out.bottom, y), std::max(out.top, y + 1)};
    }
  return out;
}

TEST_F(WornSession, HelpStandsInTheRoomBehindTheObjectForBothEyesAndGoesAgain) {
  made_->read_pictures = true;
  options_.time.longest_s = 3.0;
  options_.steps = {{1.0, "help"}, {2.0, "help"}};
  std::vector<bool> help;
  const auto done = run_view(testing::lettered_box(), options_, progress_,
                             [&](const ViewMoment& m) { help.push_back(m.viewer.ui().help); });
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(std::count(help.begin(), help.end(), true), 30);
  const auto& frames = made_->frames;
  ASSERT_GT(frames.size(), 80u);
  const auto frame = [&](double part) -> const testing::MadeFrame& {
    return frames[static_cast<std::size_t>(part * static_cast<double>(frames.size()))];
  };
  // The object's middle is half a metre before the eyes and 25 degrees under them, 23 cm. The page, 800 x 600 mm,
  // stands 25 cm behind it, its lower edge as high as its middle.
  for (const std::size_t eye : {0u, 1u}) {
    const auto& fov = frame(0.5).fov[eye];
    const auto pixel = [&](double along_m, float low, float high) {
      return testing::kMadeEyePx * (along_m / 0.75 - std::tan(low)) / (std::tan(high) - std::tan(low));
    };
    const double aside = eye == 0 ? 0.032 : -0.032;
    const Changed page = changed(frame(0.2).red[eye], frame(0.5).red[eye]);
    EXPECT_NEAR(page.left, pixel(-0.4 + aside, fov[0], fov[1]), 4.0) << eye;
    EXPECT_NEAR(page.right, pixel(0.4 + aside, fov[0], fov[1]), 4.0) << eye;
    EXPECT_NEAR(page.top, pixel(0.6 - 0.2332, fov[3], fov[2]), 4.0) << eye;
    EXPECT_GE(page.bottom, pixel(-0.2332, fov[3], fov[2]) - 1.0) << eye;
    EXPECT_LT(page.bottom, pixel(-0.05, fov[3], fov[2])) << eye << ": the page has text";
    EXPECT_EQ(frame(0.9).red[eye], frame(0.2).red[eye]) << eye << ": nothing of it is left";
  }
}

TEST_F(WornSession, TheTabletFollowsASqueezedControllerAndStaysWhereItIsLetGo) {
  made_->hands.controller = true;
  options_.time.longest_s = 4.0;
  // The object's middle: half a metre ahead, 25 degrees down.
  const glm::dvec3 centre(0, -0.2331538, -0.5), grip(0.05, -0.2, -0.45);
  const glm::dquat turned = glm::angleAxis(1.3, glm::normalize(glm::dvec3(1, 2, -0.5)));
  const glm::dvec3 moved(-0.12, 0.08, 0.2);
  int step = 0;
  const auto done = run_view(dubsar::testing::lettered_box(), options_, progress_, [&](const ViewMoment&) {
    const std::lock_guard lock(made_->mutex);
    ++step;
    const double part = std::clamp((step - 30) / 40.0, 0.0, 1.0);
    made_->hands.grip.position = grip + part * moved;
    made_->hands.grip.rotation = glm::slerp(glm::dquat(1, 0, 0, 0), turned, part);
    made_->hands.squeeze = step > 20 && step < 90 ? 1.0 : 0.0;
    if (step > 95) made_->hands.grip.position = {1, 1, 1};
  });
  ASSERT_TRUE(done) << done.error().message;
  const glm::dvec3 expected = grip + moved + turned * (centre - grip) - centre;
  const glm::dvec3 is = 0.3 * glm::dvec3(done->view.pan, done->view.nearer);
  EXPECT_LE(glm::distance(is, expected), 0.5e-3) << "metres";
  EXPECT_LE(turn_between_deg(done->view.rotation, turned), 0.2);
  EXPECT_EQ(done->view.zoom, 1.0);
}

TEST_F(WornSession, ARuntimeThatRefusesToFollowSeenHandsHasItsControllers) {
  made_->hands.controller = made_->manners.refuses_trackers = true;
  options_.time.longest_s = 3.0;
  int step = 0;
  const auto done = run_view(dubsar::testing::lettered_box(), options_, progress_, [&](const ViewMoment&) {
    const std::lock_guard lock(made_->mutex);
    made_->hands.grip.position = {0.05 + (++step > 60 ? 0.1 : 0.0), -0.2, -0.45};
    made_->hands.squeeze = step > 30 ? 1.0 : 0.0;
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_NEAR(0.3 * done->view.pan.x, 0.1, 0.5e-3) << "metres";
  EXPECT_EQ(made_->sessions_ever, 1);
}

TEST_F(WornSession, AControllerThatIsNotSqueezedMovesNothing) {
  made_->hands.controller = made_->manners.hands_from_controllers = true;
  options_.time.longest_s = 3.0;
  int step = 0;
  const auto done = run_view(dubsar::testing::lettered_box(), options_, progress_, [&](const ViewMoment&) {
    const std::lock_guard lock(made_->mutex);
    made_->hands.grip.position = {0.1 * std::sin(0.1 * ++step), -0.25, -0.48};
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->view.pan, glm::dvec2(0.0));
  EXPECT_EQ(done->view.nearer, 0.0);
  EXPECT_LT(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 1e-9);
}

TEST_F(WornSession, TheWearersQuitEndsItWithinASecond) {
  options_.time.longest_s = 30.0;
  using Clock = std::chrono::steady_clock;
  int step = 0;
  Clock::time_point quit;
  const auto done = run_view(dubsar::testing::lettered_box(), options_, progress_, [&](const ViewMoment&) {
    const std::lock_guard lock(made_->mutex);
    if (++step != 30) return;
    made_->faults.states = {testing::XrState::kVisible, testing::XrState::kSynchronized, testing::XrState::kStopping,
                            testing::XrState::kIdle, testing::XrState::kExiting};
    quit = Clock::now();
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - quit).count(), 1.0);
  EXPECT_LT(done->frames, 60);
  EXPECT_EQ(made_->sessions_ever, 1);
}

TEST_F(WornSession, TheSessionGoesOnWhenTheHeadsetIsLostAndComesBack) {
  options_.time.longest_s =
      15.0;  // the runtime is asked again after a second, and nobody waits for the pictures of a lost one
  int step = 0;
  std::size_t before = 0;
  const auto done = run_view(dubsar::testing::lettered_box(), options_, progress_, [&](const ViewMoment&) {
    const std::lock_guard lock(made_->mutex);
    if (++step == 30) before = made_->frames.size();
    made_->faults.lose_session = step >= 30 && step < 40;
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->frames, 450);
  EXPECT_GT(before, 20u);
  EXPECT_GT(made_->frames.size(), before + 50) << "pictures reach the headset again";
  EXPECT_EQ(made_->sessions_ever, 2);
  EXPECT_EQ(done->rows[0].health, SourceHealth::kPresent) << done->rows[0].reason;
}

TEST_F(WornSession, WithoutAHeadsetTheSourceSaysWhatItNeeds) {
  options_.stage.display = dubsar::testing::spec("mono");
  options_.time.longest_s = 0.2;
  const auto done = run_view(dubsar::testing::lettered_box(), options_, progress_);
  const std::string said = done ? done->rows[0].reason : done.error().message;
  EXPECT_NE(said.find("expected --display openxr"), std::string::npos) << said;
}

}  // namespace
}  // namespace dubsar::app
