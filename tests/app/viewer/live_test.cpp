// Sessions in a window of an X server without a screen: what mouse, keys and panels do.

#include <set>

#include "app/commands/sides.h"
#include "tests/app/viewer/live_fixture.h"

namespace dubsar::app {
namespace {

TEST_F(Live, ARealMouseTurnsTheObjectAndTheWindowShowsWhatAnOffscreenSessionDraws) {
  Image before, after, back;
  ViewState turned;
  const auto done = play({
      look(before),
      {[&] {
         person_->point(kX + 100, kY + 100);
         person_->press(1);
         for (int i = 1; i <= 50; ++i) person_->point(kX + 100 + 2 * i, kY + 100);
         person_->release(1);
       },
       [](const ViewMoment& m) {
         return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) > 39.9 && !m.report.moving &&
                m.report.control == Control::kNone;
       }},
      look(after),
      {[&] { turned = {}; },
       [&](const ViewMoment& m) {
         turned = m.report.view;
         return true;
       }},
      {[&] { person_->key("home"); },
       [](const ViewMoment& m) {
         return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) == 0.0 && !m.report.moving;
       }},
      look(back),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  const glm::dvec3 turn = vector_of(turned.rotation);
  EXPECT_NEAR(turn.x, 0.0, 0.02) << "to the right is about the upright axis";
  EXPECT_NEAR(turn.z, 0.0, 0.02);
  EXPECT_NE(before.at(kWidth / 2, kHeight / 2)[0], before.at(2, 2)[0]) << "the object is in the middle of the window";
  EXPECT_GT(differing_share(before, after), 0.05);
  EXPECT_EQ(differing_share(before, back), 0.0);
  EXPECT_EQ(before.pixels, offscreen("mono", ViewState()).pixels);
  EXPECT_FALSE(done->input_age_ms.empty());
  EXPECT_LT(done->frames, 200) << "nothing is drawn while nothing changes";
  EXPECT_LT(done->seconds, 20.0) << "Escape ends it";
}

TEST_F(Live, WheelAndChordsReachTheMapping) {
  double zoom = 0.0;
  glm::dvec2 zoomed{0.0}, pan{0.0};
  const auto done = play({
      {[&] {
         person_->point(kX + 50, kY + 50);
         for (int i = 0; i < 3; ++i) {
           person_->press(4);
           person_->release(4);
         }
       },
       [&](const ViewMoment& m) {
         zoom = m.report.view.zoom;
         zoomed = pan = m.report.view.pan;
         return zoom > 1.4;
       }},
      {[&] {
         person_->hold("shift");
         person_->press(1);
         person_->point(kX + 140, kY + 50);
         person_->release(1);
         person_->let_go("shift");
       },
       [&](const ViewMoment& m) {
         pan = m.report.view.pan;
         return pan != zoomed;
       }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_NEAR(zoom, std::pow(1.12, 3), 1e-9);
  // The wheel left what was under the pointer there, and the object followed the pointer by 90 pixels of 240.
  const glm::dvec2 at(-110.0 / 240, 70.0 / 240);
  EXPECT_NEAR(glm::length(at - zoomed - zoom * at), 0.0, 1e-9);
  EXPECT_NEAR(pan.x - zoomed.x, 90.0 / 240, 1e-9);
  EXPECT_EQ(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 0.0);
}

TEST_F(Live, HelpInLargeLettersGoesOnBelowThePage) {
  options_.around.scale = 2.0;
  Image first, below, end_of_it, again;
  const auto done = play({
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return m.viewer.ui().help; }},
      look(first),
      {[&] {
         for (int i = 0; i < 3; ++i) {
           person_->press(5);
           person_->release(5);
         }
       },
       [](const ViewMoment&) { return true; }},
      look(below),
      {[&] { person_->key("end"); }, [](const ViewMoment&) { return true; }},
      look(end_of_it),
      {[&] { person_->key("home"); }, [](const ViewMoment&) { return true; }},
      look(again),
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return !m.viewer.ui().help; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(differing_share(first, below), 0.05);
  EXPECT_GT(differing_share(below, end_of_it), 0.05);
  EXPECT_LT(differing_share(first, again), 0.02);
  EXPECT_EQ(done->view.zoom, 1.0) << "the object behind it stays";
}

TEST_F(Live, HelpIsShownInTheMiddleOfEveryDisplayAndGoesAgain) {
  Image plain, help, question, gone;
  const auto done = play({
      look(plain),
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return m.viewer.ui().help; }},
      look(help),
      {[&] { person_->key("escape"); },
       [](const ViewMoment& m) { return !m.viewer.ui().help; }},  // closes the help, not the window
      look(gone),
      {[&] {
         person_->hold("shift");
         person_->key("slash");
         person_->let_go("shift");
       },
       [](const ViewMoment& m) { return m.viewer.ui().help; }},
      look(question),
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return !m.viewer.ui().help; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(differing_share(plain, help), 0.2);
  EXPECT_GT(differing_share(plain, question), 0.2);
  EXPECT_EQ(differing_share(plain, gone), 0.0);
}

TEST_F(Live, KeysTurnToSidesAndUndoAndRedoGoBackAndForth) {
  Image front, bottom, back, again;
  const auto faces = [](Side side) {
    return [side](const ViewMoment& m) {
      return turn_between_deg(m.report.view.rotation, turn_to(side)) < 1e-6 && !m.report.moving;
    };
  };
  const auto done = play({
      look(front),
      {[&] { person_->key("2"); }, faces(Side::kBottom)},
      look(bottom),
      {[&] {
         person_->hold("control");
         person_->key("z");
         person_->let_go("control");
       },
       faces(Side::kObverse)},
      look(back),
      {[&] {
         person_->hold("control");
         person_->hold("shift");
         person_->key("z");
         person_->let_go("shift");
         person_->let_go("control");
       },
       faces(Side::kBottom)},
      look(again),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(differing_share(front, bottom), 0.01);
  EXPECT_EQ(differing_share(front, back), 0.0);
  EXPECT_EQ(differing_share(bottom, again), 0.0);
}

TEST_F(Live, ButtonsOnThePanelsDoWhatTheirCommandsDoAndTabTakesThePanelsAway) {
  options_.around.panels = true;
  options_.window->width = 1000;
  options_.window->height = 600;
  const auto shot_of_all = [&] { return server_->screen(kX, kY, 1000, 600); };
  Image with, without;
  std::set<Side> reached;
  std::vector<Step> steps{{{}, [&](const ViewMoment&) {
                             with = shot_of_all();
                             return true;
                           }}};
  for (int x = 20; x <= 460; x += 40)  // along the strip of sides
    steps.push_back({[&, x] {
                       person_->point(kX + x, kY + 600 - 24);
                       person_->press(1);
                       person_->release(1);
                       person_->settle();
                     },
                     [&](const ViewMoment& m) {
                       if (m.report.moving) return false;
                       reached.insert(facing_side(m.report.view.rotation));
                       return true;
                     }});
  steps.push_back({[&] {
                     person_->point(kX + 30, kY + 600 - 24);  // a drag that begins on a panel is the panel's
                     person_->press(1);
                     for (int i = 0; i < 100; ++i) person_->point(kX + 30 + i, kY + 300);
                     person_->release(1);
                     person_->point(kX + 500, kY + 5);
                     person_->settle();
                   },
                   [&](const ViewMoment& m) { return !m.report.moving && m.report.control == Control::kNone; }});
  steps.push_back({[&] { person_->key("tab"); }, [&](const ViewMoment& m) { return !m.viewer.ui().panels; }});
  steps.push_back({{}, [&](const ViewMoment&) {
                     without = shot_of_all();
                     return true;
                   }});
  steps.push_back(end());
  const auto done = play(steps);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(reached.size(), 6u);
  EXPECT_EQ(done->document.now.pan, glm::dvec2(0.0));
  double standing = 0;
  for (const Side side : {Side::kObverse, Side::kBottom, Side::kReverse, Side::kTop, Side::kLeft, Side::kRight})
    standing += turn_between_deg(done->document.now.rotation, turn_to(side)) < 1e-6;
  EXPECT_EQ(standing, 1) << "buttons turn to sides and nothing in between";
  const auto strip_at = [](const Image& image) {
    return std::vector<std::uint8_t>(image.at(0, 590), image.at(0, 591));
  };
  EXPECT_NE(strip_at(with), strip_at(without));
}

TEST_F(Live, ADragIsOneStepOfTheHistory) {
  const auto done = play({
      {[&] {
         person_->point(kX + 100, kY + 100);
         person_->press(1);
         for (int i = 1; i <= 50; ++i) person_->point(kX + 100 + i, kY + 100);
         person_->release(1);
       },
       [](const ViewMoment& m) {
         return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) > 19.9;
       }},
      {[&] {
         person_->hold("control");
         person_->key("z");
         person_->let_go("control");
       },
       [](const ViewMoment& m) {
         return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) < 1e-9 && !m.report.moving;
       }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->document.now, done->document.home);
}

}  // namespace
}  // namespace dubsar::app
