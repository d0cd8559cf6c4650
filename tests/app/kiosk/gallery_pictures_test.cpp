// The kiosk's pictures over a whole visit: no flashes, nobody waits for them, and the object answers.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/kiosk/kiosk_controller.h"
#include "app/kiosk/kiosk_screens.h"
#include "app/stage/ground_color.h"
#include "app/viewer/run_view.h"
#include "app/viewer/side_panels.h"
#include "core/image_io/png_file.h"
#include "tests/app/kiosk/flashes.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"

namespace dubsar::app::test {
namespace {

Image flat(int value) {
  Image out(64, 32, 3);
  std::fill(out.pixels.begin(), out.pixels.end(), static_cast<std::uint8_t>(value));
  return out;
}

TEST(Flashes, AreCountedAsPairsOfOpposingChanges) {
  const auto most = [](double hz, int low, int high, bool half) {
    Flashes flashes;
    for (int i = 0; i < 120; ++i) {
      Image picture = flat(low);
      const bool bright = std::fmod(i / 60.0 * hz, 1.0) < 0.5;
      for (int y = 0; bright && y < 32; ++y)
        for (int x = 0; x < (half ? 8 : 64); ++x) std::fill_n(picture.at(x, y), 3, static_cast<std::uint8_t>(high));
      flashes.add(i / 60.0, picture);
    }
    return std::pair(flashes.most_in_a_block(), flashes.most_in_a_quarter());
  };
  EXPECT_NEAR(most(5.0, 20, 220, false).second, 5, 1);
  EXPECT_LE(most(2.0, 20, 220, false).second, 3);
  EXPECT_EQ(most(5.0, 20, 60, false).first, 0) << "too small a change";
  EXPECT_NEAR(most(5.0, 20, 220, true).first, 5, 1);
  EXPECT_EQ(most(5.0, 20, 220, true).second, 0) << "a small part of the picture";
}

/// Nobody, somebody who takes hold, turns, wipes, opens, waves about, and leaves.
constexpr const char* kVisit =
    R"({"seed": 3, "duration_s": 34, "rate_hz": 60, "latency_ms": 15, "noise_mm": 0.4, "hands": [
  {"chirality": "right", "keys": [
  {"t": 2.0, "at_mm": [50, -90, 270]}, {"t": 2.6, "at_mm": [50, 10, 250]}, {"t": 4.0, "at_mm": [50, 10, 250]},
  {"t": 4.3, "grab": 1}, {"t": 5.5, "at_mm": [-60, 25, 250], "grab": 1}, {"t": 5.8, "grab": 0},
  {"t": 7.0, "at_mm": [-60, 25, 250], "grab": 0}, {"t": 7.3, "at_mm": [120, 25, 250]}, {"t": 8.0, "at_mm": [120, 25, 250]},
  {"t": 8.3, "at_mm": [-100, 25, 250]}, {"t": 9.5, "at_mm": [-100, 25, 250]},
  {"t": 10.5, "at_mm": [332, 297, 250]}, {"t": 13.5, "at_mm": [332, 297, 250]},
  {"t": 14, "at_mm": [0, 0, 200]}, {"t": 14.3, "at_mm": [150, 60, 200]}, {"t": 14.6, "at_mm": [-150, 60, 200]},
  {"t": 14.9, "at_mm": [150, -60, 200]}, {"t": 15.2, "at_mm": [-150, -60, 200]}, {"t": 15.5, "at_mm": [0, -120, 250]}]}]})";

class GalleryPictures : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::path(::testing::TempDir()) / ("visit_" + std::to_string(::getpid()) + ".json");
    std::ofstream(file_) << kVisit;
    mesh_ = testing::lettered_box();
    mesh_.partitions = {{.id = 0, .name = "tablet"}, {.id = 6, .name = "envelope"}};
    options_.mapping = gallery_mapping().value();
    options_.stage.shading = shading_preset("relief").value();
    options_.stage.screen.width_px = options_.stage.screen.window_w = 192;
    options_.stage.screen.height_px = options_.stage.screen.window_h = 108;
    options_.stage.screen.height_mm = options_.stage.screen.width_mm * 108 / 192;
    options_.inputs = {"scripted:path=" + file_.string()};
    options_.around.notices = false;
    guide_ = std::make_unique<KioskController>(parts());
    options_.guide = guide_.get();
  }
  void TearDown() override { std::filesystem::remove(file_); }
  KioskParts parts() const {
    KioskParts out;
    out.profile.objects = {{.file = "box"}};
    out.profile.pin = "90210735";
    out.profile.idle_reset_s = 8.0;
    out.profile.attract_after_s = 2.0;
    out.zone = {1e-3 * options_.mapping.hands.zone_min_mm, 1e-3 * options_.mapping.hands.zone_max_mm};
    out.wall = [] { return WallTime{1'790'000'000, 720}; };
    return out;
  }

  std::filesystem::path file_;
  TriMesh mesh_;
  ViewOptions options_;
  std::unique_ptr<KioskController> guide_;
  SilentProgress progress_;
};

TEST_F(GalleryPictures, NothingFlashesFromTheArrivalToTheReset) {
  options_.time.fps = 24.0;
  options_.time.longest_s = 33.0;
  Flashes flashes;
  double turned = 0.0;
  const auto done = run_view(mesh_, options_, progress_, [&](const ViewMoment& moment) {
    if (!moment.drawn) return;
    flashes.add(moment.frames / 24.0, moment.presenter.picture().value());
    turned = std::max(turned, turn_between_deg(moment.report.view.rotation, {1, 0, 0, 0}));
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(turned, 40.0);
  EXPECT_EQ(guide_->visit().counts().visits, 1);
  EXPECT_GE(guide_->visit().counts().openings, 1);
  EXPECT_EQ(guide_->visit().counts().resets, 1);
  EXPECT_LE(flashes.most_in_a_quarter(), 3);
  EXPECT_LE(flashes.most_in_a_quarter(), 1) << "nothing like a flash of the whole picture";
}

/// Every tenth picture of a session, by panel.
std::vector<std::vector<Image>> pictures_of(const TriMesh& mesh, ViewOptions options, KioskParts parts) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("said_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  KioskController guide(std::move(parts));
  options.guide = &guide;
  options.time.fps = 20.0;
  options.time.longest_s = 13.0;
  options.files.frames = folder;
  options.files.every = 20;
  SilentProgress progress;
  const auto done = run_view(mesh, options, progress);
  EXPECT_TRUE(done) << done.error().message;
  std::vector<std::vector<Image>> out(1 + options.also.size());
  for (int at = 0; at <= 260; at += 20)
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto file = folder / (fmt::format("frame-{:05}", at) + (i == 0 ? "" : fmt::format("-{}", i + 1)) + ".png");
      if (auto read = read_png(file.string())) out[i].push_back(*std::move(read));
    }
  std::filesystem::remove_all(folder);
  return out;
}

TEST_F(GalleryPictures, AFurtherPanelSaysAndShowsWhatItWouldAsTheOnlyOne) {
  ViewOptions alone = options_, both = options_;
  alone.stage.display = testing::spec("anaglyph");
  SidePanelOptions further;
  further.name = "anaglyph";
  further.display = alone.stage.display;
  further.screen = options_.stage.screen;
  both.also = {further};
  const auto own = pictures_of(mesh_, alone, parts()), beside = pictures_of(mesh_, both, parts());
  ASSERT_EQ(beside.size(), 2U);
  ASSERT_GE(own[0].size(), 10U);
  ASSERT_EQ(own[0].size(), beside[1].size());
  for (std::size_t i = 0; i < own[0].size(); ++i) EXPECT_EQ(own[0][i].pixels, beside[1][i].pixels) << i;
  EXPECT_NE(beside[1].front().pixels, beside[0].front().pixels);
}

TEST(GalleryOn, SignsStandAtTheEdgeOfEveryPanelAndTheMenuOnTheFirstOnly) {
  GalleryPicture main;
  main.line = "Reach out your hand";
  main.buttons = place_buttons(std::array{DwellButton::kOpen, DwellButton::kTour}, 16.0 / 9.0);
  main.buttons[1].filled = 0.4;
  main.menu = {"9  end"};
  const GalleryPicture here = gallery_on(main, 9.0 / 16.0);
  EXPECT_EQ(here.line, main.line);
  EXPECT_TRUE(here.menu.empty());
  ASSERT_EQ(here.buttons.size(), 2U);
  double left_of = 0.5;
  for (const DwellButtonPicture& button : here.buttons) {  // of an upright panel: a row from the upper right corner
    EXPECT_GT((left_of - button.at.x) * 9.0 / 16.0, button.radius) << "clear of the one before";
    EXPECT_GT(button.at.x, -0.5);
    EXPECT_GT(0.5 - button.at.y, button.radius);
    EXPECT_LT(0.5 - button.at.y, button.radius + 0.05);
    left_of = button.at.x;
  }
  EXPECT_EQ(here.buttons[1].filled, 0.4);
}

TEST_F(GalleryPictures, AHandIsInAPictureATenthOfASecondAfterItCameWithTenPicturesASecond) {
  constexpr double kCameS = 0.1 + 2.0, kTrackerS = 0.015;  // the script begins with the first picture
  options_.time.fps = 10.0;
  options_.time.longest_s = 4.0;
  Image before;
  double seen_s = 0.0;
  const auto done = run_view(mesh_, options_, progress_, [&](const ViewMoment& moment) {
    const Image picture = moment.presenter.picture().value();
    const double at_s = (moment.frames - 1) / 10.0 + 0.1;  // the first picture is that of the first step
    if (moment.viewer.stage().shown().before.empty() || seen_s > 0) {
      if (seen_s == 0) before = picture;
      return;
    }
    seen_s = at_s;
    int amber = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t *const p = picture.at(x, y), *const q = before.at(x, y);
        amber += std::abs(p[0] - q[0]) > 30;
      }
    EXPECT_GT(amber, 10) << "its ring is to be seen";
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GE(seen_s, kCameS);
  EXPECT_LE(seen_s, kCameS + kTrackerS + 0.1 + 1e-6);
}

TEST_F(GalleryPictures, AnArrowRisesWhereAHandSankBeforeItTurnedAnything) {
  std::ofstream(file_) << R"({"seed": 3, "duration_s": 9, "rate_hz": 60, "hands": [{"chirality": "right", "keys": [
    {"t": 1.0, "at_mm": [50, -60, 270]}, {"t": 3.0, "at_mm": [50, -60, 270]}, {"t": 3.4, "at_mm": [50, -140, 270]}]}]})";
  options_.time.fps = 24.0;
  options_.time.longest_s = 8.0;
  Flashes flashes;
  double from_s = 0.0, to_s = 0.0;
  const auto done = run_view(mesh_, options_, progress_, [&](const ViewMoment& moment) {
    if (!moment.drawn) return;
    const Image picture = moment.presenter.picture().value();
    flashes.add(moment.frames / 24.0, picture);
    if (!guide_->wants_higher()) return;
    if (from_s == 0.0) from_s = moment.frames / 24.0;
    to_s = moment.frames / 24.0;
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_NEAR(from_s, 3.7, 0.3);
  EXPECT_NEAR(to_s - from_s, 1.8, 0.3) << "where nobody sees a head, he has left then";
  EXPECT_LE(flashes.most_in_a_quarter(), 1);
}

TEST_F(GalleryPictures, TheObjectGlowsWhereTheHandWouldTakeItBeforeItDoes) {
  options_.time.fps = 20.0;
  options_.time.longest_s = 4.0;
  double glow_s = 0.0;
  Glow last;
  bool held = false;
  const auto done = run_view(mesh_, options_, progress_, [&](const ViewMoment& moment) {
    last = moment.viewer.stage().shown().glow;
    if (last.strength > 0.3 && glow_s == 0.0) glow_s = moment.frames / 20.0;
    held = held || moment.report.control != Control::kNone;
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(glow_s, 2.0);
  EXPECT_LT(glow_s, 3.5) << "soon after it came";
  EXPECT_FALSE(held) << "before the gesture";
  EXPECT_GT(last.at_mm.x, 0.0) << "on its side";
}

/// Pixels of words that have the object's next to them or below them: `bare` is the same picture without words.
int words_on_the_object(const Image& with, const Image& bare) {
  const auto apart = [](const std::uint8_t* a, const std::uint8_t* b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
  };
  const std::uint8_t ground[3] = {kGroundColor[0], kGroundColor[1], kGroundColor[2]};
  constexpr int kNear = 3;
  int out = 0;
  for (int y = kNear; y < with.height - kNear; ++y)
    for (int x = kNear; x < with.width - kNear; ++x) {
      if (apart(with.at(x, y), bare.at(x, y)) < 60 || *with.at(x, y) < 150) continue;  // no letter
      bool object = false;
      for (int dy = -kNear; dy <= kNear; ++dy)
        for (int dx = -kNear; dx <= kNear; ++dx) {
          const std::uint8_t *const here = with.at(x + dx, y + dy), *const was = bare.at(x + dx, y + dy);
          object = object || (apart(here, was) <= 2 && apart(here, ground) > 12);  // it is seen there
          object =
              object || (apart(was, ground) > 12 && apart(here, ground) > 12 && apart(here, was) < 60);  // or through
        }
      out += object;
    }
  return out;
}

/// Pixels of the object that something else covers.
int changed_of_the_object(const Image& with, const Image& bare) {
  int out = 0;
  for (std::size_t p = 0; p + 2 < bare.pixels.size(); p += 3) {
    const auto was = [&](std::size_t c) { return std::abs(bare.pixels[p + c] - kGroundColor[c]) > 12; };
    const auto is = [&](std::size_t c) { return std::abs(with.pixels[p + c] - bare.pixels[p + c]) > 12; };
    out += (was(0) || was(1) || was(2)) && (is(0) || is(1) || is(2));
  }
  return out;
}

TEST_F(GalleryPictures, WordsStandBesideTheObjectAndNeverOnItOnEveryScreenOfFourShapes) {
  for (const auto& [width, height] : {std::pair{960, 540}, {720, 540}, {720, 720}, {540, 960}}) {
    Screen& screen = options_.stage.screen;
    screen.width_px = screen.window_w = width;
    screen.height_px = screen.window_h = height;
    screen.width_mm = width > height ? 344.0 : 300.0 * width / height;
    screen.height_mm = screen.width_mm * height / width;
    KioskParts told = parts();
    told.profile.objects[0].title = {{"en", "A sealed contract of two merchants from Kanesh"}};
    const auto with = kiosk_screens(mesh_, options_, told, progress_);
    const auto bare = kiosk_screens(mesh_, options_, told, progress_, false);
    ASSERT_TRUE(with && bare);
    ASSERT_EQ(with->size(), 6U) << width;
    ASSERT_EQ(bare->size(), with->size());
    int letters = 0;
    for (std::size_t i = 0; i < with->size(); ++i) {
      EXPECT_EQ(words_on_the_object((*with)[i].picture, (*bare)[i].picture), 0)
          << (*with)[i].name << " " << width << "x" << height;
      if ((*with)[i].name == "teaching") {
        EXPECT_EQ(changed_of_the_object((*with)[i].picture, (*bare)[i].picture), 0) << width << "x" << height;
      }
      for (std::size_t p = 0; p < (*with)[i].picture.pixels.size(); ++p)
        letters += (*with)[i].picture.pixels[p] > (*bare)[i].picture.pixels[p] + 60;
    }
    EXPECT_GT(letters, 10'000) << "else there were no words";
  }
}

}  // namespace
}  // namespace dubsar::app::test
