#pragma once
// A session in a window of an X server without a screen, with real mouse and key events, for tests.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "app/viewer/run_view.h"
#include "display/render/context/context_egl.h"
#include "display/render/passes/compose_pass.h"
#include "tests/app/viewer/x_person.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"
#include "tests/display/xvfb_server.h"

namespace dubsar::app {

/// Only what never comes waits so long: a session of .2 s of work took 18 s where fourteen programs wanted one core.
inline constexpr double kLongestS = 80;

inline constexpr int kX = 200, kY = 150, kWidth = 320, kHeight = 240;

class Live : public ::testing::Test {
 protected:
  /// One server for all suites of a process: GLFW stays connected to the first.
  static void SetUpTestSuite() {
    if (server_ != nullptr) return;
    server_ = std::make_unique<testing::XvfbServer>();
    if (server_->problem().empty()) person_ = std::make_unique<testing::XPerson>();
  }
  void SetUp() override {
    if (!server_->problem().empty()) GTEST_SKIP() << server_->problem();
    ASSERT_TRUE(person_->here());
    person_->type_where_the_pointer_is();
    person_->point(kX + 5, kY + 5);
    options_.mapping = default_mapping().value();
    options_.stage.shading = shading_preset("relief").value();
    options_.stage.quality = Quality::kAdaptive;
    options_.stage.samples = 2;
    options_.window = WindowOptions();
    options_.window->width = kWidth;
    options_.window->height = kHeight;
    options_.window->x = kX;
    options_.window->y = kY;
    options_.window->decorated = false;
    options_.fullscreen = false;
    options_.inputs = {"mouse", "keyboard"};  // not what the machine of the test has
    options_.around.notices = false;
    options_.time.longest_s = kLongestS;
  }

  /// One thing after another: each step acts, and the next comes when its condition holds in a turn that had
  /// nothing to draw.
  struct Step {
    std::function<void()> act;
    std::function<bool(const ViewMoment&)> done;
    bool ends = false;  ///< the session, maybe before another turn comes
  };
  Result<ViewResult> play(std::vector<Step> steps, Progress* progress = nullptr) {
    SilentProgress silent;
    std::size_t at = 0;
    bool acted = false;
    auto out = run_view(
        testing::lettered_box(), options_, progress != nullptr ? *progress : silent, [&](const ViewMoment& moment) {
          if (at >= steps.size() || moment.drawn || moment.frames == 0 || moment.viewer.stage().coarse_views() > 0)
            return;
          if (!acted && steps[at].act) steps[at].act();
          if (!acted) {
            acted = true;
            return;
          }
          if (!steps[at].done(moment)) return;
          ++at;
          acted = false;
        });
    if (acted && steps[at].ends) ++at;
    EXPECT_EQ(at, steps.size()) << "the step that never came true";
    expect_ended(out);
    return out;
  }
  /// Not by its time.
  void expect_ended(const Result<ViewResult>& out) const {
    if (out && options_.time.longest_s == kLongestS) {
      EXPECT_LT(out->seconds, kLongestS) << "the last step did not end it";
    }
  }
  Image shot() const { return server_->screen(kX, kY, kWidth, kHeight); }
  Step look(Image& into) {
    return {{}, [this, &into](const ViewMoment& moment) {
              screen_ = moment.presenter.window()->screen();  // asks the server, so that it has done all before
              into = shot();
              return true;
            }};
  }
  /// The second time for the question that a session with work in it asks.
  Step end() {
    return {[] {
              person_->key("escape");
              person_->key("escape");
            },
            [](const ViewMoment&) { return true; }, true};
  }
  Step end_without_work() {
    return {[] { person_->key("escape"); }, [](const ViewMoment&) { return true; }, true};
  }
  /// Escape closes what is open before it ends a session.
  Step close_drawer() {
    return {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().drawer.empty(); }};
  }
  Image offscreen(const std::string& display, const ViewState& view) const {
    StageOptions options = options_.stage;
    options.display = testing::spec(display);
    options.quality = Quality::kExact;
    options.screen = screen_;
    auto context = EglContext::create();
    EXPECT_TRUE(context);
    auto stage = Stage::create(testing::lettered_box(), options).value();
    auto surface = OffscreenSurface::create(stage->traits().output).value();
    FollowedEyes eyes;
    eyes.presence = Presence::kOff;
    stage->show({view, 1.0, options.shading.style, options.shading.other, options.shading.parts}, eyes, 1);
    EXPECT_TRUE(stage->paint(surface.surface()));
    return surface.read().value();
  }

  inline static std::unique_ptr<testing::XvfbServer> server_;
  inline static std::unique_ptr<testing::XPerson> person_;
  ViewOptions options_;
  Screen screen_;
};

inline double differing_share(const Image& a, const Image& b) {
  if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 1.0;
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) differ += std::abs(a.pixels[i] - b.pixels[i]) > 8;
  return static_cast<double>(differ) / static_cast<double>(a.pixels.size());
}

}  // namespace dubsar::app
