// Several windows of one session, and windows that go on from one session to the next.

#include <algorithm>

#include "app/viewer/side_panels.h"
#include "tests/app/viewer/live_fixture.h"

namespace dubsar::app {
namespace {

constexpr int kSideX = 700, kSideY = 500;

class LivePanels : public Live {
 protected:
  SidePanelOptions side(const std::string& display) const {
    SidePanelOptions out;
    out.name = display;
    out.display = testing::spec(display);
    out.window = *options_.window;
    out.window.x = kSideX;
    out.window.y = kSideY;
    out.fullscreen = false;
    return out;
  }
  static Image side_shot() { return server_->screen(kSideX, kSideY, kWidth, kHeight); }
  static int lit(const Image& image) {
    return static_cast<int>(std::count_if(image.pixels.begin(), image.pixels.end(), [](int v) { return v > 60; }));
  }
};

TEST_F(LivePanels, AMonitorThatIsNotThereIsSaidInWordsAndTheSessionGoesOn) {
  options_.also = {side("mono")};
  options_.also[0].window.monitor = "wall";
  const auto done = play({{[&] { person_->key("right"); },
                           [&](const ViewMoment& m) {
                             return turn_between_deg(m.viewer.report().view.rotation, {1, 0, 0, 0}) > 3.0;
                           }},
                          end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_NE(done->also.at(0).trouble.find("no monitor's name contains \"wall\""), std::string::npos);
}

TEST_F(LivePanels, TheNextSessionIsInTheSameWindowWithoutAMomentOfTheDesktop) {
  KeptPanels kept;
  const void* window = nullptr;
  int dark = 0, looks = 0;
  const auto session = [&](int turns) {
    SilentProgress progress;
    int turn = 0;
    const auto done = run_view(
        testing::lettered_box(), options_, progress,
        [&](const ViewMoment& m) {
          if (looks > 0 && turn == 0) dark += lit(shot()) < 1000;
          looks += lit(shot()) >= 1000;
          if (window == nullptr) window = m.presenter.window()->handle();
          EXPECT_EQ(m.presenter.window()->handle(), window);
          if (++turn >= turns && looks > 3) m.presenter.end();
        },
        nullptr, &kept);
    EXPECT_TRUE(done) << done.error().message;
    if (kept.main) kept.main->keep_open();
  };
  options_.also = {side("mono")};
  session(10);
  ASSERT_TRUE(kept.main);
  EXPECT_GT(lit(shot()), 1000) << "between the two";
  EXPECT_GT(lit(side_shot()), 1000);
  session(10);
  EXPECT_GT(lit(shot()), 1000);
  EXPECT_EQ(dark, 0);
}

}  // namespace
}  // namespace dubsar::app
