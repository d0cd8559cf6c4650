// What a session does when its window is covered, resized, or busy.

#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/app/viewer/live_fixture.h"

namespace dubsar::app {
namespace {

TEST_F(Live, DisplaysAreSwitchedWhileItRuns) {
  options_.displays = {
      {"anaglyph"}, {"interlaced"}, testing::spec("quilt:columns=4,rows=2,width=400,height=200,aspect=1.3,cone=40")};
  std::vector<std::string> shown;
  std::vector<Image> shots;
  std::vector<Step> steps;
  for (int i = 0; i < 5; ++i) {
    if (i > 0)
      steps.push_back(
          {[&] { person_->key("f2"); }, [&](const ViewMoment& m) { return m.viewer.display() != shown.back(); }});
    steps.push_back({{}, [&](const ViewMoment& m) {
                       screen_ = m.presenter.window()->screen();
                       shown.push_back(m.viewer.display());
                       shots.push_back(shot());
                       return true;
                     }});
  }
  steps.push_back(end());
  const auto done = play(steps);
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(shown, (std::vector<std::string>{"mono", "anaglyph", "interlaced", options_.displays[2].text(), "mono"}));
  for (const std::size_t i : {0u, 1u, 2u, 4u})
    EXPECT_EQ(shots[i].pixels, offscreen(shown[i], ViewState()).pixels) << shown[i];
  // A quilt has its own size: it is fitted into the window, with black above and below.
  const Image& quilt = shots[3];
  EXPECT_EQ(quilt.at(160, 20)[0], 0);
  EXPECT_NE(quilt.at(160, 60)[0], 0);
  EXPECT_GT(differing_share(quilt, shots[0]), 0.2);
}

TEST_F(Live, AnInterlacedWindowKeepsTheParityOfThePanel) {
  options_.stage.display = {"interlaced"};
  Image here;
  const auto done = play({
      look(here),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(here.pixels, offscreen("interlaced", ViewState()).pixels);
  EXPECT_EQ(screen_.window_x, kX);
  EXPECT_EQ(screen_.window_y, kY);
}

TEST_F(Live, FullScreenAndBack) {
  PixelSize size;
  const auto done = play({
      {[&] { person_->key("f11"); },
       [&](const ViewMoment& m) {
         return m.presenter.window()->fullscreen() && m.presenter.window()->size() == PixelSize{1920, 1200};
       }},
      {{},
       [&](const ViewMoment& m) {
         size = m.viewer.stage().traits().output;
         return size.width == 1920;
       }},
      {[&] { person_->key("f11"); },
       [&](const ViewMoment& m) {
         return !m.presenter.window()->fullscreen() && m.viewer.stage().traits().output == PixelSize{kWidth, kHeight};
       }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(size, (PixelSize{1920, 1200}));
}

TEST_F(Live, AFloodOfMotionsWhileAPictureIsMadeNeitherLosesTheReleaseNorTheDrag) {
  ViewState dragged;
  const auto done = play({
      {[&] {
         person_->point(kX + 100, kY + 20);  // beside the surface: by the pointer's way
         person_->press(1);
         for (int i = 0; i < 5000; ++i) person_->point(kX + 100 + i % 100, kY + 20);
         person_->point(kX + 150, kY + 20);
         person_->release(1);
         for (int i = 0; i < 5000; ++i) person_->point(kX + 150 + i % 40, kY + 120);
         person_->settle();  // all of it has come before the next turn of the loop
       },
       [&](const ViewMoment& m) {
         dragged = m.report.view;
         return m.report.control == Control::kNone && m.report.view.rotation.w != 1.0;
       }},
      {[&] {
         for (int i = 0; i < 50; ++i) person_->point(kX + 100, kY + 100 + i);
         person_->settle();
       },
       [](const ViewMoment&) { return true; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  // 50 pixels to the right between press and release, at 0.4 degrees each.
  EXPECT_LT(turn_between_deg(dragged.rotation, turn_of({0, 20 * std::numbers::pi / 180, 0})), 0.01);
  EXPECT_EQ(turn_between_deg(dragged.rotation, done->view.rotation), 0.0) << "the button is up: the drag has ended";
}

TEST_F(Live, TenThousandMotionsDuringAPictureOfThreeSecondsEndTheDrag) {
  SilentProgress silent;
  int turns_after = -1;
  ViewState released, moved_on;
  options_.time.longest_s = 60;
  const auto done = run_view(testing::lettered_box(), options_, silent, [&](const ViewMoment& m) {
    if (m.frames == 0) return;
    if (turns_after < 0) {  // the loop is held up here as by a slow picture, while steering goes on in its thread
      person_->point(kX + 100, kY + 20);  // beside the surface: by the pointer's way
      person_->press(1);
      const TimestampNs start = SteadyClock().now();
      for (int i = 0; i < 10'000; ++i) {
        person_->point(kX + 100 + i % 100, kY + 20);
        if (i % 100 == 99) person_->settle();
        const auto due = start + i * TimestampNs{300'000};
        std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<TimestampNs>(0, due - SteadyClock().now())));
      }
      person_->point(kX + 150, kY + 20);
      person_->release(1);
      for (int i = 0; i < 100; ++i) person_->point(kX + 150 + i % 40, kY + 130);
      person_->settle();
      EXPECT_GE(SteadyClock().now() - start, 2'900'000'000);
      turns_after = 0;
      return;
    }
    if (m.report.control == Control::kNone && !m.report.moving && m.report.view.rotation.w != 1.0) {
      if (turns_after == 0) {
        released = m.report.view;
        for (int i = 0; i < 50; ++i) person_->point(kX + 100 + i, kY + 100 + i);
        person_->settle();
      }
      if (++turns_after > 20) {
        moved_on = m.report.view;
        m.presenter.window()->close();
      }
    }
  });
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_GT(turns_after, 20) << "the drag never ended";
  // 50 pixels to the right between press and release, at 0.4 degrees each.
  EXPECT_LT(turn_between_deg(released.rotation, turn_of({0, 20 * std::numbers::pi / 180, 0})), 0.01);
  EXPECT_EQ(turn_between_deg(released.rotation, moved_on.rotation), 0.0);
}

TEST_F(Live, EscapeThatIsHeldClosesTheHelpAndNotTheWindow) {
  double pressed_s = 0.0;
  const auto seconds = [] { return 1e-9 * static_cast<double>(SteadyClock().now()); };
  const auto done = play({
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return m.viewer.ui().help; }},
      {[&] {
         person_->hold("escape");
         pressed_s = seconds();
       },
       [&](const ViewMoment& m) {
         return !m.viewer.ui().help && seconds() - pressed_s > 1.5;
       }},  // keys repeat after 0.66 s
      {[&] { person_->let_go("escape"); }, [](const ViewMoment& m) { return !m.presenter.window()->should_close(); }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
}

TEST_F(Live, WhatAnotherWindowOrMinimisingSpoiltIsShownAgain) {
  Image before, covered, uncovered, restored;
  const auto done = play({
      look(before),
      {[&] {
         person_->cover(kX, kY, kWidth, kHeight / 2);
         covered = shot();
         person_->uncover();
       },
       [&](const ViewMoment&) { return shot().pixels == before.pixels; }},
      {[&] {
         person_->minimise();
         person_->restore();
       },
       [&](const ViewMoment&) { return shot().pixels == before.pixels; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(differing_share(before, covered), 0.3);
}

TEST_F(Live, TheFirstPictureAndThoseOfAWindowThatIsResizedAreCoarseAndExactAtRest) {
  SilentProgress silent;
  constexpr int kSizes = 12;
  int asked = 0, drawn = 0, coarse = 0;
  bool first_coarse = false, exact_at_rest = false;
  options_.time.longest_s = 30;
  const auto done = run_view(testing::lettered_box(), options_, silent, [&](const ViewMoment& m) {
    if (m.frames == 0) return;
    const PixelSize now = m.viewer.stage().traits().output;
    if (m.drawn && m.frames == 1) first_coarse = m.viewer.stage().coarse_views() > 0;
    if (asked > 0 && m.drawn && asked < kSizes) {
      ++drawn;
      coarse += m.viewer.stage().coarse_views() > 0;
    }
    if (now.width != kWidth + asked) return;
    if (asked < kSizes) {
      person_->resize(kWidth + ++asked, kHeight);
    } else if (m.viewer.stage().coarse_views() == 0) {
      exact_at_rest = true;
      m.presenter.window()->close();
    }
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_TRUE(first_coarse);
  EXPECT_GE(drawn, kSizes - 1);
  EXPECT_EQ(coarse, drawn);
  EXPECT_TRUE(exact_at_rest);
}

}  // namespace
}  // namespace dubsar::app
