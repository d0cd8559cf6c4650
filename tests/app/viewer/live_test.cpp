// Sessions in a window of an X server without a screen, with real mouse and key events.

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "app/calibration/adjust_window.h"
#include "app/commands/sides.h"
#include "app/panels/help_page.h"
#include "app/viewer/display_clock.h"
#include "app/viewer/run_view.h"
#include "core/base/atomic_file.h"
#include "display/render/compose_pass.h"
#include "display/render/context_egl.h"
#include "input/input_recording.h"
#include "tests/app/viewer/x_person.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"
#include "tests/display/xvfb_server.h"

namespace dubsar::app {
namespace {

constexpr int kX = 200, kY = 150, kWidth = 320, kHeight = 240;

class Live : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    server_ = std::make_unique<testing::XvfbServer>();
    if (server_->problem().empty()) person_ = std::make_unique<testing::XPerson>();
  }
  static void TearDownTestSuite() {
    person_.reset();
    server_.reset();
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
    options_.notices = false;
    options_.longest_s = 20;  // a test that waits for something that never comes
  }

  /// One thing after another: each step acts, and the next comes when its condition holds in a turn that had
  /// nothing to draw.
  struct Step {
    std::function<void()> act;
    std::function<bool(const ViewMoment&)> done;
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
    EXPECT_EQ(at, steps.size()) << "the step that never came true";
    return out;
  }
  Image shot() const { return server_->screen(kX, kY, kWidth, kHeight); }
  Step look(Image& into) {
    return {{}, [this, &into](const ViewMoment& moment) {
              screen_ = moment.presenter.window()->screen();  // asks the server, so that it has done all before
              into = shot();
              return true;
            }};
  }
  Step end() {
    return {[this] { person_->key("escape"); }, [](const ViewMoment&) { return true; }};
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
    stage->show({view, 1.0, options.shading.style, options.shading.parts}, eyes, 1);
    EXPECT_TRUE(stage->paint(surface.surface()));
    return surface.read().value();
  }

  inline static std::unique_ptr<testing::XvfbServer> server_;
  inline static std::unique_ptr<testing::XPerson> person_;
  ViewOptions options_;
  Screen screen_;
};

double differing_share(const Image& a, const Image& b) {
  if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 1.0;
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) differ += std::abs(a.pixels[i] - b.pixels[i]) > 8;
  return static_cast<double>(differ) / static_cast<double>(a.pixels.size());
}

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
         return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) > 39.9;
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
  // 100 pixels to the right at 0.4 degrees each, about the upright axis.
  EXPECT_LT(turn_between_deg(turned.rotation, turn_of({0, 40 * std::numbers::pi / 180, 0})), 0.01);
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

TEST_F(Live, HelpIsShownInTheMiddleOfEveryDisplayAndGoesAgain) {
  Image plain, help, question, gone;
  const auto done = play({
      look(plain),
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return m.viewer.desk().help; }},
      look(help),
      {[&] { person_->key("escape"); },
       [](const ViewMoment& m) { return !m.viewer.desk().help; }},  // closes the help, not the window
      look(gone),
      {[&] {
         person_->hold("shift");
         person_->key("slash");
         person_->let_go("shift");
       },
       [](const ViewMoment& m) { return m.viewer.desk().help; }},
      look(question),
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return !m.viewer.desk().help; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(differing_share(plain, help), 0.2);
  EXPECT_GT(differing_share(plain, question), 0.2);
  EXPECT_EQ(differing_share(plain, gone), 0.0);
}

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

TEST_F(Live, KeysOnAPanelChangeItsFiguresAndSaveThem) {
  const auto root = std::filesystem::temp_directory_path() / ("dubsar_tuner_" + std::to_string(::getpid()));
  const auto folder = root / "panels";
  auto tuner = LensTuner::create(options_.stage.catalog, folder, "lens-sheet-24-5-views");
  ASSERT_TRUE(tuner) << tuner.error().message;
  const std::string first = tuner->text();
  options_.stage.display = tuner->display();
  options_.stage.pattern = true;
  options_.displays = {{"mono"}};
  std::string taken;
  options_.commands = tuner->commands();
  for (Command& command : options_.commands)
    command.run = [&taken, run = command.run, key = command.keys.front().key](Editor& editor,
                                                                              const std::string& argument) {
      taken += key + " ";
      return run(editor, argument);
    };
  Image before, moved, back;
  const auto took = [&](const char* keys) { return [&, keys](const ViewMoment&) { return taken == keys; }; };
  const auto done = play({
      look(before),
      {[&] { person_->key("right"); }, took("right ")},
      {[&] { person_->key("right"); }, took("right right ")},
      look(moved),
      {[&] { person_->key("s"); }, took("right right s ")},
      {[&] { person_->key("0"); }, took("right right s 0 ")},
      look(back),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(differing_share(before, moved), 0.001);
  EXPECT_EQ(before.pixels, back.pixels);
  EXPECT_EQ(tuner->text(), first);
  EXPECT_TRUE(tuner->saved());
  const auto profile = load_panels(folder).find("lens-sheet-24-5-views");
  ASSERT_TRUE(profile) << profile.error().message;
  ASSERT_TRUE(profile->adjustment.center);
  const auto untouched = built_in_panels().find("lens-sheet-24-5-views");
  EXPECT_NEAR(*profile->adjustment.center - untouched->sheet->center, 0.02, 1e-9);
  EXPECT_EQ(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 0.0) << "the arrows belong to the panel";
  std::filesystem::remove_all(root);
}

/// A device that a test plugs in and out; it pushes the object to the right while it is there.
struct FakeDevice {
  std::atomic<bool> plugged{true};
  std::atomic<int> starts{0};
};
class FakeSource final : public InputSource {
 public:
  explicit FakeSource(std::shared_ptr<FakeDevice> device) : device_(std::move(device)) {}
  std::string_view name() const noexcept override { return "fake"; }
  Result<void> start() override { return {}; }
  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    if (!device_->plugged) return Freshness::kLost;
    newest.time = now;
    return Freshness::kNew;
  }

 private:
  std::shared_ptr<FakeDevice> device_;
};

TEST_F(Live, ALostSourceIsNamedAndUsedAgainAndAMissingOneIsTriedAgain) {
  auto device = std::make_shared<FakeDevice>();
  std::atomic<bool> second_is_there{false};
  options_.inputs = {"mouse", "fake", "absent"};
  options_.make_input = [&](std::string_view spec, const InputConfig& config) -> Result<std::unique_ptr<InputSource>> {
    if (spec == "absent" && !second_is_there)
      return fail(ErrorKind::kUnavailable, "input absent: no such device is plugged in");
    if (spec == "absent" || spec == "fake") {
      ++device->starts;
      return std::make_unique<FakeSource>(device);
    }
    return make_input(spec, config);
  };
  std::string reason;
  const auto health = [](std::size_t index, SourceHealth wanted) {
    return [index, wanted](const ViewMoment& m) {
      return m.viewer.sources().size() == 3 && m.viewer.sources()[index].health == wanted;
    };
  };
  const auto done = play({
      {{}, health(1, SourceHealth::kPresent)},
      {{},
       [&](const ViewMoment& m) {
         reason = m.viewer.sources()[2].reason;
         return m.viewer.sources()[2].health == SourceHealth::kMissing;
       }},
      {[&] { device->plugged = false; }, health(1, SourceHealth::kLost)},
      {[&] { device->plugged = true; }, health(1, SourceHealth::kPresent)},
      {[&] {
         second_is_there = true;
         person_->key("f5");
       },
       health(2, SourceHealth::kPresent)},
      {[&] {
         person_->key("f1");
         person_->key("2");
       },
       health(1, SourceHealth::kOff)},
      {[&] { person_->key("2"); }, health(1, SourceHealth::kPresent)},
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return !m.viewer.desk().help; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_NE(reason.find("no such device"), std::string::npos) << reason;
  EXPECT_EQ(device->starts, 3);
  ASSERT_EQ(done->rows.size(), 3u);
  EXPECT_EQ(done->rows[2].health, SourceHealth::kPresent);
}

TEST_F(Live, MistakesInTheInputsAreRefusedAndNothingElseIsTriedInTheirPlace) {
  SilentProgress progress;
  options_.inputs = {"mouse", "crystal_ball"};
  auto done = run_view(testing::lettered_box(), options_, progress);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kUsage) << done.error().message;
  options_.inputs = {"absent"};
  options_.make_input = [](std::string_view, const InputConfig&) -> Result<std::unique_ptr<InputSource>> {
    return fail(ErrorKind::kPermission, "input absent: not allowed");
  };
  done = run_view(testing::lettered_box(), options_, progress);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kPermission);
}

TEST_F(Live, ItEndsByClosingByTimeAndBySignal) {
  SilentProgress cancelled;
  options_.longest_s = 0.3;
  SilentProgress progress;
  auto done = run_view(testing::lettered_box(), options_, progress);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GE(done->seconds, 0.3);
  EXPECT_LT(done->seconds, 2.3);
  options_.longest_s = 20;
  done = run_view(testing::lettered_box(), options_, progress, [](const ViewMoment& m) {
    if (m.frames > 0) m.presenter.window()->close();
  });
  ASSERT_TRUE(done);
  EXPECT_LT(done->seconds, 5.0);
  const TimestampNs start = SteadyClock().now();
  TimestampNs asked = start;
  options_.record = std::filesystem::temp_directory_path() / fmt::format("dubsar_live_{}.jsonl", ::getpid());
  done = run_view(testing::lettered_box(), options_, cancelled, [&](const ViewMoment& m) {
    if (m.frames == 0 || cancelled.cancelled()) return;
    asked = SteadyClock().now();
    cancelled.cancel();
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kCancelled);
  EXPECT_LT(SteadyClock().now() - asked, 2'000'000'000);
  EXPECT_TRUE(parse_input_recording(read_text_file(options_.record).value(), "what was recorded before Ctrl-C"));
  std::filesystem::remove(options_.record);
}

TEST_F(Live, KeysThatTheSessionItselfTakesAreInItsRecording) {
  options_.record = std::filesystem::temp_directory_path() / fmt::format("dubsar_live_keys_{}.jsonl", ::getpid());
  const auto help = [](bool open) { return [open](const ViewMoment& m) { return m.viewer.desk().help == open; }; };
  const auto done = play({{[] { person_->key("f1"); }, help(true)},
                          {[] { person_->key("f1"); }, help(false)},
                          {[] { person_->key("right"); },
                           [](const ViewMoment& m) {
                             return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) > 4.9;
                           }},
                          end()});
  ASSERT_TRUE(done) << done.error().message;
  const auto frames = parse_input_recording(read_text_file(options_.record).value(), "recording");
  ASSERT_TRUE(frames) << frames.error().message;
  std::string keys;
  for (const RecordedFrame& frame : *frames)
    for (const InputEvent& event : frame.frame.events)
      if (event.kind == EventKind::kKey && event.down) keys += event.key + " ";
  EXPECT_EQ(keys, "f1 f1 right escape ");
  std::filesystem::remove(options_.record);
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
         person_->point(kX + 100, kY + 100);
         person_->press(1);
         for (int i = 0; i < 5000; ++i) person_->point(kX + 100 + i % 100, kY + 100);
         person_->point(kX + 150, kY + 100);
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

TEST_F(Live, EscapeThatIsHeldClosesTheHelpAndNotTheWindow) {
  double pressed_s = 0.0;
  const auto seconds = [] { return 1e-9 * static_cast<double>(SteadyClock().now()); };
  const auto done = play({
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return m.viewer.desk().help; }},
      {[&] {
         person_->hold("escape");
         pressed_s = seconds();
       },
       [&](const ViewMoment& m) {
         return !m.viewer.desk().help && seconds() - pressed_s > 1.5;
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
  options_.longest_s = 30;
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
  options_.panels = true;
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
  steps.push_back({[&] { person_->key("tab"); }, [&](const ViewMoment& m) { return !m.viewer.desk().panels; }});
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

TEST(DisplayClock, LightIsTheMiddleOfTheScanAfterThePictureIsReady) {
  DisplayClock clock(100.0);  // 10 ms
  const TimestampNs ms = 1'000'000;
  EXPECT_EQ(clock.light(0), 15 * ms);
  clock.presented(100 * ms, 104 * ms, 110 * ms);     // takes 4 ms, the beat is at 110
  EXPECT_EQ(clock.light(111 * ms), (120 + 5) * ms);  // ready at 115
  EXPECT_EQ(clock.light(117 * ms), (130 + 5) * ms);  // ready at 121: misses one
  EXPECT_EQ(clock.light(1000 * ms), (1010 + 5) * ms);
  EXPECT_EQ(clock.next_start(), (110 - 4 + 10) * ms);
  DisplayClock unknown(0.0);
  EXPECT_EQ(unknown.period(), 16'666'666);
}

TEST(HelpPage, SaysWhatTheMappingSays) {
  const auto find = [](const std::vector<HelpSection>& page, std::string_view title,
                       std::string_view what) -> std::string {
    for (const HelpSection& section : page)
      if (section.title == title)
        for (const HelpRow& row : section.rows)
          if (row.what == what) return row.does;
    return {};
  };
  const CommandTable commands = CommandTable::standard({"relief"});
  const KeyTable keys = KeyTable::create(commands).value();
  const auto page = help_page(default_mapping().value(), keys);
  EXPECT_EQ(find(page, "Mouse", "left drag"), "turn");
  EXPECT_EQ(find(page, "Mouse", "shift+left drag"), "move");
  EXPECT_EQ(find(page, "Mouse", "wheel"), "zoom");
  EXPECT_EQ(find(page, "Back", "backspace ctrl+z"), "undo");
  EXPECT_EQ(find(page, "This window", "p l t"), "panel: parts, light, style");
  EXPECT_EQ(find(page, "Sides", "1 to 6"), "turn to a side: obverse, bottom, reverse, top, left, right");
  EXPECT_EQ(find(page, "Hands", "pinch and move"), "move the light");
  EXPECT_EQ(find(page, "This window", "f1 ?"), "this help");
  const auto museum =
      help_page(parse_mapping(R"({"hands": {"pinch": "none"}, "mouse": {"alt+left": "light", "wheel": null},
      "priority": ["hands", "mouse"]})",
                              "museum")
                    .value(),
                keys);
  EXPECT_EQ(find(museum, "Mouse", "alt+left drag"), "move the light");
  EXPECT_EQ(find(museum, "Mouse", "wheel"), "");
  EXPECT_EQ(find(museum, "Hands", "pinch and move"), "");
  EXPECT_EQ(find(museum, "Back", "backspace ctrl+z"), "") << "the keyboard does not steer";
}

}  // namespace
}  // namespace dubsar::app
