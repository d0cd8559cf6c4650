// The kiosk in a window that covers the screen, among people who try everything.

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/kiosk/kiosk_controller.h"
#include "core/base/system/log.h"
#include "devices/touch/simulated_touch.h"
#include "tests/app/viewer/live_fixture.h"
#include "tests/app/viewer/x_desktop.h"
#include "tests/app/viewer/x_manager.h"

namespace dubsar::app {
namespace {

constexpr int kEvents = 10'000, kAtOnce = 100;

class LiveKiosk : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (server_ == nullptr) server_ = std::make_unique<testing::XvfbServer>(320, 240);
  }
  void SetUp() override {
    if (!server_->problem().empty()) GTEST_SKIP() << server_->problem();
    person_ = std::make_unique<testing::XPerson>();
    desktop_ = std::make_unique<testing::XDesktop>();
    ASSERT_TRUE(person_->here());
    person_->point(160, 120);
    options_.mapping = gallery_mapping().value();
    options_.stage.shading = shading_preset("relief").value();
    options_.window = WindowOptions();
    options_.fullscreen = true;
    options_.inputs = {"mouse", "touch"};
    options_.sources.make = [this](std::string_view spec, const InputConfig& config) {
      InputConfig with = config;
      with.reach_device = [this](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
        return OpenTransport([this] { return panel_.device().open(); });
      };
      return make_input(spec, with);
    };
    options_.around.notices = false;
    options_.time.longest_s = 120;  // a test that waits for something that never comes
    key_file_ = std::filesystem::path(::testing::TempDir()) / fmt::format("operator_{}", ::getpid());
    std::filesystem::remove(key_file_);
    KioskParts parts;
    parts.profile.objects = {{.file = "box"}};
    parts.profile.pin = "90210735";
    parts.profile.key_file = key_file_;
    parts.wall = [this] { return WallTime{++seconds_, 12 * 60}; };  // each picture is a second: the file is looked for
    guide_ = std::make_unique<KioskController>(std::move(parts));
    options_.guide = guide_.get();
  }
  void TearDown() override {
    unmanaged_ = true;
    std::filesystem::remove(key_file_);
  }
  /// Magenta pixels on the screen: of what lies behind the kiosk.
  int seen_of_the_desktop() const {
    const Image screen = server_->screen(0, 0, 320, 240);
    int count = 0;
    for (int y = 0; y < screen.height; ++y)
      for (int x = 0; x < screen.width; ++x) {
        const std::uint8_t* const p = screen.at(x, y);
        count += p[0] > 240 && p[1] < 15 && p[2] > 240;
      }
    return count;
  }
  /// One thing at random that fingers do, or somebody to the panel's cable, or noise on it.
  void anything_touched(std::mt19937& random) {
    const auto share = [&] { return static_cast<double>(random() % 1001) / 1000; };
    const auto kind = random() % 64;
    const auto finger = static_cast<std::uint32_t>(random() % 8);
    if (kind == 0) panel_.device().unplug();
    if (kind <= 3) panel_.device().plug();
    if (kind == 4) fingers_.clear();
    if (kind == 5) {
      std::vector<std::byte> noise(24 * (1 + random() % 4));
      for (std::byte& b : noise) b = static_cast<std::byte>(random());
      panel_.device().send(noise);
    } else if (kind < 30) {
      fingers_.erase(finger);
    } else {
      fingers_[finger] = {share(), share()};
    }
    panel_.touch(touched_ += 1'000'000, fingers_);
  }
  void type(std::string_view digits) {
    for (const char digit : digits) person_->key(std::string(1, digit));
    person_->key("enter");
  }

  inline static std::unique_ptr<testing::XvfbServer> server_;  // one for all suites: GLFW stays connected to it
  inline static bool unmanaged_ = false;  // GLFW was begun in this process, and looked for a manager once
  std::unique_ptr<testing::XPerson> person_;
  std::unique_ptr<testing::XDesktop> desktop_;
  std::unique_ptr<KioskController> guide_;
  TouchPanelSim panel_;
  std::map<std::uint32_t, glm::dvec2> fingers_;
  TimestampNs touched_ = 1'000'000'000;
  ViewOptions options_;
  std::filesystem::path key_file_;
  std::int64_t seconds_ = 1'790'000'000;
};

TEST_F(LiveKiosk, TenThousandEventsAtRandomNeitherReachTheDesktopNorEndItAndTheOperatorsFileDoes) {
  EXPECT_GT(seen_of_the_desktop(), 70'000) << "else nothing is shown by its absence";
  std::mt19937 random(60220);
  int sent = 0, reached = 0, by_fingers = 0, seen = 0, pictures = 0;
  bool ready = false, ended_early = true;
  SilentProgress progress;
  const auto out = run_view(testing::lettered_box(), options_, progress, [&](const ViewMoment& moment) {
    if (moment.frames < 2) return;
    if (!ready) {
      person_->type_where_the_pointer_is();
      static_cast<void>(desktop_->reached());  // before the window stood there
      ready = true;
    }
    if (sent < kEvents) {
      for (int i = 0; i < kAtOnce; ++i, ++sent) {
        desktop_->anything(random);
        anything_touched(random);
      }
      by_fingers += moment.report.control == Control::kMouse;
      desktop_->settle();
      reached += desktop_->reached();
      if (sent % 1000 == 0) {
        seen += seen_of_the_desktop();
        ++pictures;
      }
      return;
    }
    if (!std::filesystem::exists(key_file_)) {
      desktop_->let_go();
      ended_early = false;
      std::ofstream(key_file_) << "here\n";
      return;
    }
    person_->key("9");
  });
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_FALSE(ended_early) << "after " << sent << " events";
  EXPECT_EQ(sent, kEvents);
  EXPECT_EQ(reached, 0) << "events behind the kiosk";
  EXPECT_GT(by_fingers, 10) << "else the fingers were not felt";
  EXPECT_EQ(pictures, 10);
  EXPECT_EQ(seen, 0) << "pixels of what is behind the kiosk";
  EXPECT_TRUE(guide_->ended());
  EXPECT_EQ(guide_->object(), 1U) << "as many as there are: over";
}

TEST_F(LiveKiosk, TheNumberOpensTheMenuThatEndsIt) {
  int turn = 0;
  SilentProgress progress;
  const auto out = run_view(testing::lettered_box(), options_, progress, [&](const ViewMoment& moment) {
    if (moment.frames < 2) return;
    if (turn == 0) {
      person_->type_where_the_pointer_is();
      person_->key("9");  // does nothing yet
      person_->key("escape");
      type("90210735");
    }
    if (turn > 0 && turn % 5 == 0) person_->key("9");
    ++turn;
  });
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_TRUE(guide_->ended());
  EXPECT_GT(turn, 1);
}

TEST_F(LiveKiosk, SomethingCoarseIsShownAndLedWhileTheFileIsRead) {
  const std::filesystem::path file = key_file_.string() + ".ply";
  std::ofstream(file) << "some surface\n";
  std::atomic<bool> may_come = false;
  FileLoader loader(
      [&](const std::filesystem::path& path, Progress&, const TellCoarse& tell) -> Result<OpenedSurface> {
        tell(testing::sphere(20.0f, 12, 24));
        while (!may_come) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        OpenedSurface out;
        out.mesh = testing::lettered_box();
        out.title = path.filename().string();
        return out;
      },
      {});
  ASSERT_TRUE(loader.open({file}));
  const std::size_t all = testing::lettered_box().triangles.size();
  int coarse = 0, whole = 0;
  SilentProgress progress;
  const auto out = run_view(
      TriMesh(), options_, progress,
      [&](const ViewMoment& moment) {
        if (moment.viewer.shows_surface() && !moment.viewer.has_surface()) {
          if (++coarse == 1) person_->type_where_the_pointer_is();
          if (coarse == 3) type("90210735");  // an operator need not wait
          may_come = coarse > 5;
        }
        if (moment.viewer.mesh().triangles.size() == all && ++whole % 5 == 1) person_->key("9");
      },
      &loader);
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_GT(coarse, 5);
  EXPECT_GT(whole, 0);
  EXPECT_TRUE(guide_->ended());
  EXPECT_EQ(out->triangles, all);
  std::filesystem::remove(file);
}

TEST_F(LiveKiosk, WhatAVisitorTurnedWhileTheSurfaceWasCoarseStaysTurned) {
  const std::filesystem::path file = key_file_.string() + ".ply";
  std::ofstream(file) << "some surface\n";
  std::atomic<bool> may_come = false;
  FileLoader loader(
      [&](const std::filesystem::path&, Progress&, const TellCoarse& tell) -> Result<OpenedSurface> {
        tell(testing::sphere(20.0f, 12, 24));
        while (!may_come) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        OpenedSurface out;
        out.mesh = testing::lettered_box();
        return out;
      },
      {});
  ASSERT_TRUE(loader.open({file}));
  int coarse = 0;
  TimestampNs came = -1;
  double before_deg = 0.0, after_deg = 0.0, pan = 0.0;
  const auto turned_deg = [](const Viewer& viewer) {
    return turn_between_deg(view_of(viewer.document()).rotation, home_of(viewer.document()).rotation);
  };
  SilentProgress progress;
  const SteadyClock clock;
  const auto out = run_view(
      TriMesh(), options_, progress,
      [&](const ViewMoment& moment) {
        if (!moment.viewer.has_surface()) {
          if (!moment.viewer.shows_surface()) return;
          ++coarse;
          if (coarse == 3) person_->press(1);
          if (coarse > 3 && coarse <= 13) person_->point(160 + 4 * (coarse - 3), 120);
          if (coarse == 14) person_->release(1);
          if (coarse < 40) return;
          before_deg = turned_deg(moment.viewer);
          may_come = true;
          return;
        }
        if (came < 0) came = clock.now();
        if (clock.now() - came < 1'500'000'000) return;  // any glide is over
        after_deg = turned_deg(moment.viewer);
        pan = glm::length(view_of(moment.viewer.document()).pan);
        moment.presenter.end();
        if (!std::filesystem::exists(key_file_)) std::ofstream(key_file_) << "here\n";
        person_->key("9");
      },
      &loader);
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_GT(before_deg, 5.0) << "else nothing was turned";
  EXPECT_NEAR(after_deg, before_deg, 1.0);
  EXPECT_EQ(pan, 0.0);
  std::filesystem::remove(file);
}

TEST_F(LiveKiosk, AnotherObjectInTheSameWindowIsDrawnWithoutAnErrorOfGl) {
  std::vector<std::string> said;
  set_log_handler([&](LogLevel level, std::string_view text) {
    if (level >= LogLevel::kWarning) said.emplace_back(text);
  });
  KeptPanels kept;
  SilentProgress progress;
  for (int object = 0; object < 3; ++object) {
    guide_->begin_object();
    options_.time.longest_s = 0.5;
    const auto out = run_view(testing::lettered_box(), options_, progress, {}, nullptr, &kept);
    ASSERT_TRUE(out) << out.error().message;
    EXPECT_GT(out->frames, 1);
  }
  set_log_handler({});
  for (const std::string& text : said) EXPECT_EQ(text.find("gl"), std::string::npos) << text;
}

/// Under a window manager with the keys that its distribution gives it.
class ManagedKiosk : public LiveKiosk {
 protected:
  void SetUp() override {
    if (unmanaged_) GTEST_SKIP() << "GLFW has looked for a window manager before there was one: run it alone";
    LiveKiosk::SetUp();
    if (IsSkipped()) return;
    desktop_.reset();
    manager_ = std::make_unique<testing::XManager>();
    if (!manager_->problem().empty()) GTEST_SKIP() << manager_->problem();
  }
  void TearDown() override {
    manager_.reset();
    std::filesystem::remove(key_file_);
  }
  void chord(std::initializer_list<const char*> modifiers, const char* key) {
    for (const char* modifier : modifiers) person_->hold(modifier);
    person_->key(key);
    for (const char* modifier : modifiers) person_->let_go(modifier);
    person_->settle();
  }
  struct Seen {
    bool hidden = false;   ///< not on the screen, not over all of it, or without the keys, at some time
    double back_s = -1.0;  ///< from the deed until nothing of that was so any longer; -1: never
  };
  /// What becomes of a kiosk that somebody does `deed` to, watched for `kWatchedS`, and whether an operator can end it
  /// then.
  Seen after(const std::function<void(xcb_window_t)>& deed) {
    constexpr double kWatchedS = 2.2, kUntilHiddenS = 1.0;
    const SteadyClock clock;
    Seen out;
    TimestampNs done = -1, asked = -1;
    SilentProgress progress;
    const auto ended = run_view(testing::lettered_box(), options_, progress, [&](const ViewMoment& moment) {
      const GlfwWindow& window = *moment.presenter.window();
      const bool whole = window.on_screen() && window.focused() && window.covers_monitor();
      const TimestampNs now = clock.now();
      if (moment.frames < 2) return;
      if (done < 0) {
        if (!whole) return;
        if (asked < 0) asked = now;
        if (now - asked < 700'000'000) return;  // it has found its place
        done = now;
        return deed(manager_->active());
      }
      const double since_s = 1e-9 * static_cast<double>(now - done);
      out.hidden = out.hidden || !whole;
      if (!whole) out.back_s = -1.0;
      if (whole && out.hidden && out.back_s < 0.0) out.back_s = since_s;
      if (since_s < (out.hidden ? kWatchedS : kUntilHiddenS)) return;
      if (!typed_) type("90210735");
      if (typed_) person_->key("9");
      typed_ = true;
    });
    EXPECT_TRUE(ended) << ended.error().message;
    EXPECT_TRUE(guide_->ended()) << "the operator's number was not heard";
    return out;
  }
  static void expect_back(const Seen& seen) {
    EXPECT_TRUE(seen.hidden) << "what was done did nothing: nothing is shown by its return";
    EXPECT_GE(seen.back_s, 0.0) << "it never came back";
    EXPECT_LT(seen.back_s, 2.0);
  }
  std::unique_ptr<testing::XManager> manager_;
  bool typed_ = false;
};

TEST_F(ManagedKiosk, IsBackWhenAKeyShowsTheDesktop) {
  expect_back(after([&](xcb_window_t) { chord({"super"}, "d"); }));
}

TEST_F(ManagedKiosk, IsOnEveryDesktopThatAKeyGoesTo) {
  const Seen seen = after([&](xcb_window_t) { chord({"control", "alt"}, "right"); });
  if (seen.hidden) expect_back(seen);  // it need not be
}

TEST_F(ManagedKiosk, IsBackWhenItIsMinimised) {
  expect_back(after([&](xcb_window_t window) { manager_->minimise(window); }));
}

TEST_F(ManagedKiosk, IsBackWhenItIsSentToAnotherDesktop) {
  expect_back(after([&](xcb_window_t window) {
    manager_->send_to_desktop(window, 1);
    chord({"control", "alt"}, "left");
  }));
}

}  // namespace
}  // namespace dubsar::app
