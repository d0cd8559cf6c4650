#include "app/kiosk/kiosk_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "app/document/document.h"
#include "app/kiosk/hand_cursors.h"
#include "app/panels/tutorial_picture.h"
#include "tests/app/kiosk/led_kiosk.h"

namespace dubsar::app {
namespace {

TEST(KioskController, AnObjectNobodyHoldsMovesSlowlyAndStopsWithoutAJump) {
  Kiosk kiosk;
  kiosk.go_on(40);
  EXPECT_GT(kiosk.fastest_deg_per_s, 1.0);
  EXPECT_LE(kiosk.fastest_deg_per_s, 6.0);
  kiosk.fastest_deg_per_s = 0.0;
  kiosk.go_on(4, with_hand(HandState::kReady));
  EXPECT_LE(kiosk.fastest_deg_per_s, 12.0);  // it swings back within a hand's way to it
  const auto still = kiosk.go_on(1, with_hand(HandState::kReady));
  EXPECT_LT(turn_between_deg(still.turn, {1, 0, 0, 0}), 1e-6);
}

TEST(KioskController, SaysTheTitleAndInvitesInTheLanguageOfTheOperator) {
  KioskProfile profile;
  profile.languages = {"de", "en"};
  Kiosk kiosk(profile);
  auto picture = *kiosk.go_on(1).picture;
  EXPECT_EQ(picture.title, "B");
  EXPECT_EQ(picture.line, Words().say(Line::kInvite, "de"));
  kiosk.type("8302");
  picture = *kiosk.go_on(0.1).picture;
  EXPECT_GT(picture.menu.size(), OperatorMenu::rows().size());
  kiosk.press("2");
  EXPECT_EQ(kiosk.go_on(0.1).picture->title, "A");
}

/// A hand whose ring lies on a button of a panel of 600 x 340 mm.
Steered on_the_button(double turned_deg = 0.0, DwellButton which = DwellButton::kOpen) {
  Steered out = with_hand(HandState::kReady, Control::kNone, turned_deg);
  const HandZone zone;
  const auto button = place_buttons(std::array{which}, 600.0 / 340.0).front();
  const glm::dvec2 middle = 0.5 * glm::dvec2(zone.min_m + zone.max_m), half = 0.5 * glm::dvec2(zone.max_m - zone.min_m);
  out.hands[0].place_m = glm::dvec3(middle + half * button.at / 0.45, 0.2);
  return out;
}

TEST(KioskController, RestingOnTheSignOpensTheEnvelopeSmoothlyAfterTheObjectWasTurned) {
  Kiosk kiosk;
  kiosk.go_on(1, with_hand(HandState::kReady));
  kiosk.go_on(4, on_the_button());
  EXPECT_EQ(kiosk.document().unpack, 0.0) << "there is no button yet";
  for (int i = 0; i < 20; ++i) kiosk.go_on(0.05, with_hand(HandState::kHolding, Control::kHands, 2.0 * i));
  kiosk.go_on(4, with_hand(HandState::kReady, Control::kNone, 38.0));
  EXPECT_EQ(kiosk.document().unpack, 0.0) << "a hand beside the button";
  const auto half = kiosk.go_on(1, on_the_button(38.0));
  ASSERT_EQ(half.picture->buttons.size(), 2U);
  EXPECT_GT(half.picture->buttons[0].filled, 0.3);
  EXPECT_LT(half.picture->buttons[0].filled, 0.9);
  kiosk.go_on(4, on_the_button(38.0));
  EXPECT_EQ(kiosk.document().unpack, 1.0);
  const auto later = kiosk.go_on(10, on_the_button(38.0));  // the hand stays: it does not close again
  EXPECT_EQ(kiosk.document().unpack, 1.0);
  EXPECT_EQ(later.picture->buttons.at(0).button, DwellButton::kClose);
  double last = 0.0, largest = 0.0;
  for (const std::string& command : kiosk.commands)
    if (command.rfind("unpack ", 0) == 0) {
      largest = std::max(largest, std::abs(std::stod(command.substr(7)) - last));
      last = std::stod(command.substr(7));
    }
  EXPECT_LT(largest, 5.0);  // percent a picture
}

TEST(KioskController, AHandWalksTheTourLeavesItWhereItIsAndComesBack) {
  KioskProfile profile;
  profile.objects = {{.file = "a.exa"}};
  profile.idle_reset_s = 20;
  Kiosk kiosk(profile);
  kiosk.go_on(1, with_hand(HandState::kReady));
  const auto starts = kiosk.go_on(2.5, on_the_button(0.0, DwellButton::kTour));
  ASSERT_TRUE(starts.scene) << "a hand that rests on the button begins it, without ever having closed";
  EXPECT_EQ(starts.picture->title, Words().say(Line::kTourSealed, "en"));
  EXPECT_EQ(starts.picture->steps, 5U);
  EXPECT_FALSE(starts.picture->tutorial);
  const auto peel = kiosk.go_on(38.0);  // the hand sinks: one looks on
  ASSERT_TRUE(peel.scene) << "the tour goes on for somebody who only looks";
  EXPECT_GE(peel.picture->step, 3U);
  EXPECT_LT(kiosk.fastest_deg_per_s, 120.0);
  const auto back = kiosk.go_on(0.3, with_hand(HandState::kHolding));
  ASSERT_TRUE(back.scene);
  EXPECT_FALSE(back.scene->camera) << "a hand that takes hold has it at once";
  const auto free = kiosk.go_on(3.0, with_hand(HandState::kReady));
  EXPECT_FALSE(free.scene);
  const auto again = kiosk.go_on(2.5, on_the_button(0.0, DwellButton::kTour));
  ASSERT_TRUE(again.scene);
  EXPECT_EQ(again.picture->step, peel.picture->step) << "where it was left";
  kiosk.go_on(32.0);
  EXPECT_FALSE(kiosk.go_on(0.05).scene) << "it ends";
  EXPECT_EQ(kiosk.document().unpack, 1.0);
  kiosk.go_on(30.0);
  EXPECT_EQ(kiosk.document().unpack, 0.0) << "nobody came back";
  EXPECT_TRUE(kiosk.document().parts[1].visible);
}

TEST(KioskController, TheTourOfAnObjectIsThatOfItsFileOnceItIsRead) {
  KioskProfile profile;
  profile.objects = {{.file = "a.exa"}};
  Kiosk kiosk(profile);
  kiosk.reads();
  kiosk.go_on(1, with_hand(HandState::kReady));
  EXPECT_FALSE(kiosk.go_on(2.5, on_the_button(0.0, DwellButton::kTour)).scene) << "of what is not there yet";
  kiosk.has_read();
  kiosk.go_on(1, with_hand(HandState::kReady));
  const auto starts = kiosk.go_on(2.5, on_the_button(0.0, DwellButton::kTour));
  ASSERT_TRUE(starts.scene);
  EXPECT_EQ(starts.picture->steps, 5U) << "with the envelope, which was not known before";
  kiosk.guide().begin_object();
  kiosk.reads();
  EXPECT_FALSE(kiosk.go_on(1.0).scene) << "the tour before does not walk through the next object";
}

TEST(KioskController, AnObjectThatCannotBeReadGivesItsPlaceToTheNext) {
  KioskProfile profile;
  profile.objects = {{.file = "a.exa"}, {.file = "b.exa"}, {.file = "c.exa"}};
  Kiosk kiosk(profile);
  const auto names = [&] {
    std::string out;
    for (const KioskObject& object : kiosk.guide().objects()) out += object.file.stem().string();
    return out;
  };
  kiosk.guide().leave_out(0, "a.exa is damaged");
  EXPECT_EQ(names(), "bc");
  EXPECT_EQ(kiosk.guide().object(), 0U);
  kiosk.type("8302");
  kiosk.press("1");  // on to the last
  EXPECT_TRUE(kiosk.go_on(0.05).end);
  EXPECT_EQ(kiosk.guide().object(), 1U);
  kiosk.guide().leave_out(1, "b.exa is damaged");
  EXPECT_EQ(names(), "b");
  EXPECT_EQ(kiosk.guide().object(), 0U) << "behind the last comes the first";
}

TEST(KioskController, TheOperatorsPageSaysHowThingsStandAndMakesThePanelBrighter) {
  KioskProfile profile;
  profile.languages = {"de", "en"};
  profile.brightness = 0.5;
  profile.quiet.push_back({18 * 60, 9 * 60 + 30});
  Kiosk kiosk(profile);
  std::vector<SourceRow> rows;
  rows.push_back({"leap", SourceHealth::kLost, "no such device is plugged in"});
  rows.push_back({"touch", SourceHealth::kPresent, ""});
  kiosk.set_sources(rows);
  kiosk.go_on(1, with_hand(HandState::kReady));
  kiosk.type("8302");
  kiosk.press("+");
  std::string page;
  const Guidance later = kiosk.go_on(5);
  for (const std::string& row : later.picture->menu) page += row + "\n";
  for (const std::string& said : std::vector<std::string>{
           "object 1 of 2, language de, brightness 60 %", "visits today: 1; dark 18:00-09:30", "touch: works\n",
           "leap: lost, no such device is plugged in\n", "12:00 leap: no such device is plugged in\n", "-  darker\n"})
    EXPECT_NE(page.find(said), std::string::npos) << said << " in\n" << page;
  EXPECT_NEAR(kiosk.go_on(0.1).picture->dark, 0.4, 1e-6);
}

TEST(KioskController, SeveralObjectsChangeAtAReset) {
  KioskProfile profile;
  profile.objects = {{.file = "a.exa"}, {.file = "b.exa"}};
  profile.idle_reset_s = 20;
  Kiosk kiosk(profile);
  kiosk.go_on(1, with_hand(HandState::kReady));
  for (int i = 0; i < 20; ++i) kiosk.go_on(0.05, with_hand(HandState::kHolding, Control::kHands, 2.0 * i));
  EXPECT_EQ(kiosk.guide().object(), 0U);
  bool ended = false;
  for (int i = 0; i < 30 * 20 && !ended; ++i) ended = kiosk.go_on(0.05).end;
  EXPECT_TRUE(ended);
  EXPECT_TRUE(kiosk.guide().ended());
  EXPECT_EQ(kiosk.guide().object(), 1U);
  kiosk.guide().begin_object();
  kiosk.go_on(60);
  EXPECT_EQ(kiosk.guide().object(), 1U) << "nobody has moved it since";
}

TEST(KioskController, AFingerOnTheGlassChoosesASignAtOnce) {
  Kiosk kiosk;
  kiosk.go_on(1, with_hand(HandState::kReady));
  InputEvent event;
  event.kind = EventKind::kButton;
  event.down = true;
  const auto button = place_buttons(std::array{DwellButton::kTour}, 600.0 / 340.0).front();
  event.at = button.at * glm::dvec2(600.0 / 340.0, 1.0);
  EXPECT_TRUE(kiosk.guide().takes(event, 0)) << "twice on a button is not twice on the object";
  EXPECT_TRUE(kiosk.go_on(0.1, with_hand(HandState::kReady)).scene);
  event.at = glm::dvec2(0.0, 0.0);
  EXPECT_FALSE(kiosk.guide().takes(event, 0));
}

TEST(KioskController, WithATouchPanelAloneItInvitesFingersAndTeachesNoFists) {
  Kiosk kiosk;
  const Words words;
  EXPECT_EQ(kiosk.go_on(1).picture->line, words.say(Line::kInvite, "en"));
  kiosk.set_sources({{"mouse", SourceHealth::kPresent, ""}, {"touch:turn=90", SourceHealth::kPresent, ""}});
  EXPECT_EQ(kiosk.go_on(1).picture->line, words.say(Line::kTouch, "en"));
  EXPECT_FALSE(kiosk.go_on(1).picture->tutorial);
  Steered touched;
  touched.control = Control::kMouse;
  for (int i = 0; i < 40; ++i) {
    touched.view.rotation = turn_of({0, 0.02 * i, 0});
    touched.view.zoom = 1.0 + 0.01 * i;
    EXPECT_FALSE(kiosk.go_on(0.05, touched).picture->tutorial);
  }
  EXPECT_EQ(kiosk.guide().visit().counts().visits, 1);
  EXPECT_EQ(kiosk.guide().visit().counts().done[static_cast<std::size_t>(Tutorial::kTurn)], 1);
  EXPECT_EQ(kiosk.guide().visit().counts().done[static_cast<std::size_t>(Tutorial::kTwoHands)], 1);
  EXPECT_FALSE(kiosk.go_on(0.1, Steered()).picture->buttons.empty()) << "what a tap can choose is there";
  kiosk.set_sources({{"mouse", SourceHealth::kPresent, ""}, {"touch", SourceHealth::kLost, "unplugged"}});
  kiosk.go_on(120);
  EXPECT_EQ(kiosk.go_on(1).picture->line, words.say(Line::kNoTracker, "en"));
}

TEST(KioskController, ATapOnASignIsSomebodyWhoIsThere) {
  Kiosk kiosk;
  InputEvent event;
  event.kind = EventKind::kButton;
  event.down = true;
  event.at = glm::dvec2(0.0, 0.0);
  kiosk.guide().takes(event, 0);
  kiosk.go_on(0.1);
  EXPECT_EQ(kiosk.guide().visit().counts().visits, 1);
}

TEST(KioskController, GoesBackToTheBeginningWhenNobodyComesBack) {
  KioskProfile profile;
  profile.idle_reset_s = 20;
  profile.attract_after_s = 4;
  Kiosk kiosk(profile);
  for (int i = 0; i < 20; ++i) kiosk.go_on(0.05, with_hand(HandState::kHolding, Control::kHands, 2.0 * i));
  kiosk.go_on(18);
  EXPECT_EQ(std::count(kiosk.commands.begin(), kiosk.commands.end(), "reset"), 0);
  kiosk.go_on(10);
  EXPECT_EQ(std::count(kiosk.commands.begin(), kiosk.commands.end(), "reset"), 1);
}

TEST(KioskController, IsDarkInQuietHoursAndNeverFlashes) {
  KioskProfile profile;
  profile.quiet = {{18 * 60, 9 * 60}};
  Kiosk kiosk(profile);
  EXPECT_EQ(kiosk.go_on(1).picture->dark, 0.0);
  kiosk.set_minute(20 * 60);
  double last = 0.0, step = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double dark = kiosk.go_on(0.05).picture->dark;
    step = std::max(step, std::abs(dark - last));
    last = dark;
  }
  EXPECT_GT(last, 0.9);
  EXPECT_LT(step, 0.05);
  EXPECT_TRUE(kiosk.go_on(0.05).picture->line.empty());
}

TEST(KioskController, OnlyTheOperatorEndsIt) {
  Kiosk kiosk;
  const std::vector<std::string> keys{"escape", "f4", "f11",  "q",  "tab",    "enter",
                                      "1",      "9",  "home", "f1", "delete", "5"};
  std::mt19937 random(60219);
  for (int i = 0; i < 10'000; ++i) {
    kiosk.press(keys[random() % keys.size()]);
    if (i % 50 == 0) {
      EXPECT_FALSE(kiosk.go_on(0.05).end);
    }
  }
  EXPECT_TRUE(kiosk.commands.empty());
  kiosk.go_on(45);  // a lock after wrong numbers is over
  kiosk.type("8302");
  kiosk.press("1");
  EXPECT_TRUE(kiosk.go_on(0.05).end);
  EXPECT_EQ(kiosk.guide().object(), 1U);
  kiosk.guide().begin_object();
  kiosk.type("8302");
  kiosk.press("9");
  EXPECT_TRUE(kiosk.go_on(0.05).end);
  EXPECT_EQ(kiosk.guide().object(), 2U);  // as many as there are: over
}

TEST(HandRings, StandWhereTheHandIsWithinThePanelAndAComfortableDepth) {
  const CursorScene stage{{{-0.35, -0.25, -0.2}, {0.35, 0.35, 0.6}}, {600, 340}, {0, 0}};
  const auto middle = cursor_place_mm(stage, {0.0, 0.05, 0.2});
  EXPECT_NEAR(middle.x, 0.0, 1e-9);
  EXPECT_NEAR(middle.y, 0.0, 1e-9);
  const auto right = cursor_place_mm(stage, {0.2, 0.05, 0.2}), near = cursor_place_mm(stage, {0.0, 0.05, 0.5});
  EXPECT_GT(right.x, 100.0);
  EXPECT_GT(near.z, middle.z);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-2.0, 2.0);
  for (int i = 0; i < 1000; ++i) {
    const auto at = cursor_place_mm(stage, {anywhere(random), anywhere(random), anywhere(random)});
    EXPECT_LE(std::abs(at.x), 300.0);
    EXPECT_LE(std::abs(at.y), 170.0);
    EXPECT_LE(at.z, 0.13 * 340);
    EXPECT_GE(at.z, -0.06 * 340);
  }
  EXPECT_EQ(hand_cursors(stage, std::vector<HandMark>{{{0, 0, 0.2}}}).size(), 1U);
  EXPECT_EQ(hand_cursors(stage, std::vector<HandMark>{{{0, 0, 0.2}, 0.0, 0.5}}).size(), 2U);
  EXPECT_TRUE(hand_cursors(stage, {}).empty());
}

TEST(HandRings, TheArrowRisesFromWhereTheHandSankWithinThePanelAndNeverBlinks) {
  const CursorScene stage{{{-0.35, -0.25, -0.2}, {0.35, 0.35, 0.6}}, {600, 340}, {0, 0}};
  const glm::dvec3 sank{0.1, -0.4, 0.3}, ring = cursor_place_mm(stage, sank);
  double last = 0.0;
  for (double t = 0.0; t < 6.0; t += 1.0 / 60.0) {
    const std::vector<LinesItem> button = higher_arrow(stage, sank, t);
    ASSERT_FALSE(button.empty());
    const LinesItem& arrow = button.back();
    ASSERT_EQ(arrow.points_mm.size(), 6U);
    EXPECT_GT(arrow.points_mm[0].y, ring.y);
    EXPECT_GT(arrow.points_mm[1].y, arrow.points_mm[0].y + 20.0) << "upwards";
    for (const glm::dvec3& at : arrow.points_mm) EXPECT_LT(std::abs(at.y), 170.0);
    EXPECT_GE(arrow.opacity, last) << "it comes once, and stays";
    EXPECT_LT(arrow.opacity - last, 0.06);
    last = arrow.opacity;
  }
  EXPECT_GT(last, 0.9);
}

TEST(LessonPicture, MovesWithoutJumpsAndNeverFlashes) {
  for (std::size_t i = 0; i < kTutorialCount; ++i) {
    const auto tutorial = static_cast<Tutorial>(i);
    TutorialPose last = tutorial_pose(tutorial, 0.0);
    bool moved = false;
    for (double t = 0.01; t < 12.0; t += 0.01) {
      const TutorialPose pose = tutorial_pose(tutorial, t);
      if (pose.opacity > 0.01f && last.opacity > 0.01f) {  // where it can be seen
        EXPECT_LT(std::hypot(pose.x - last.x, pose.y - last.y), 0.06f) << i << " at " << t;
        EXPECT_LT(std::abs(pose.closing - last.closing), 0.05f) << i << " at " << t;
      }
      EXPECT_LT(std::abs(pose.opacity - last.opacity), 0.05f) << i << " at " << t;
      moved = moved || pose.x != last.x || pose.y != last.y || pose.closing != last.closing || pose.ring != last.ring;
      last = pose;
    }
    EXPECT_TRUE(moved) << i;
  }
}

TEST(GalleryPage, LettersGrowWithTheDistance) {
  EXPECT_NEAR(letter_height_mm(1.5), 8.7, 0.1);
  EXPECT_NEAR(letter_height_mm(3.0), 2 * letter_height_mm(1.5), 1e-9);
}

}  // namespace
}  // namespace dubsar::app
