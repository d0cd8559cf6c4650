// Drawers of a window: they are opened, gone through and typed in by mouse and keys.

#include "tests/app/viewer/live_fixture.h"

namespace dubsar::app {
namespace {

constexpr int kWide = 800, kHigh = 600;

class LiveDrawers : public Live {
 protected:
  LiveDrawers() {
    options_.around.panels = true;
    options_.window = WindowOptions();
  }
  void SetUp() override {
    Live::SetUp();
    options_.window->width = kWide;
    options_.window->height = kHigh;
  }
  static void click(int x, int y) {
    person_->point(kX + x, kY + y);
    person_->press(1);
    person_->release(1);
    person_->settle();
  }
  /// A click in each turn, each `step` pixels below the one before, until something has come of it.
  static Step click_down(int x, int from, int step, const std::function<bool(const ViewMoment&)>& done) {
    return click_down(x, std::make_shared<int>(from), step, done);
  }
  /// `y` is the one that comes next.
  static Step click_down(int x, const std::shared_ptr<int>& y, int step,
                         const std::function<bool(const ViewMoment&)>& done) {
    return {{}, [=](const ViewMoment& m) {
              if (done(m)) return true;
              if (*y > 0 && *y < kHigh) click(x, std::exchange(*y, *y + step));
              return false;
            }};
  }
  static std::function<bool(const ViewMoment&)> drawer(const std::string& name) {
    return [name](const ViewMoment& m) { return m.viewer.ui().drawer == name; };
  }
  static std::function<bool(const ViewMoment&)> text(const std::string& words) {
    return [words](const ViewMoment& m) {
      return m.viewer.document().notes.size() == 1 && m.viewer.document().notes[0].text == words;
    };
  }
};

TEST_F(LiveDrawers, TheWholeLineOfATabOpensItsDrawer) {
  const auto done = play({
      click_down(kWide - 14, 45, 4, drawer("light")),  // beside the word
      {[] { person_->key("escape"); }, drawer("")},
      click_down(71, 45, 4, [](const ViewMoment& m) { return m.viewer.ui().tool == "note"; }),
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "turn"; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
}

TEST_F(LiveDrawers, WhatALongDrawerHasAtItsEndIsReachedWithItsBar) {
  options_.around.scale = 1.4;
  options_.steps = {{0.0, "drawer style"}};
  constexpr int kBar = 661;    // where the drawer ends
  constexpr int kBoxes = 305;  // where it begins
  const auto done = play({
      {{}, drawer("style")},
      {[] {
         person_->point(kX + kBar, kY + 90);
         person_->press(1);
         for (int y = 90; y <= 500; y += 10) person_->point(kX + kBar, kY + y);
         person_->release(1);
         person_->settle();
       },
       [](const ViewMoment&) { return true; }},
      // Upwards from the drawer's end: what stands last is the switch of the mark, and below it what that means.
      click_down(kBoxes, kHigh - 80, -5, [](const ViewMoment& m) { return !m.viewer.document().style.evidence; }),
      {[] { person_->key("escape"); }, drawer("")},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
}

TEST_F(LiveDrawers, ALetterThatIsPressedStandsWhereIsTyped) {
  const auto row = std::make_shared<int>(110);  // of the letters, once it was found
  const auto done = play({
      {[] { person_->key("n"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "note"; }},
      {[] {
         click(400, 300);
         person_->key("s");
         person_->key("a");
       },
       text("sa")},
      click_down(kWide - 345, row, 4, text("sa\u0161")),
      {[] {
         person_->key("d");
         person_->key("e");
       },
       text("sa\u0161de")},
      {[] {
         for (int i = 0; i < 5; ++i) person_->key("left");
         person_->key("x");
       },
       text("xsa\u0161de")},
      {[row] { click(kWide - 345, *row - 4); }, text("x\u0161sa\u0161de")},
      {[] { person_->key("k"); }, text("x\u0161ksa\u0161de")},
      {[] { person_->key("escape"); }, text("x\u0161ksa\u0161de")},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().tool == "turn"; }},
      {[] { person_->key("escape"); }, drawer("")},
      {[] { person_->key("escape"); }, [](const ViewMoment& m) { return m.viewer.ui().leaving; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->document.style, Document().style) << "e was typed, not pressed";
}

}  // namespace
}  // namespace dubsar::app
