// How much work a first picture is: of a large surface, on the display with the most views, without a graphics card.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "app/stage/stage.h"
#include "core/base/system/clock.h"
#include "display/render/context/context_egl.h"
#include "display/render/passes/compose_pass.h"
#include "tests/display/spec.h"
#include "tests/pace.h"

namespace dubsar::app {
namespace {

constexpr int kAround = 1696, kAlong = 848;  // 1.44 million vertices
constexpr double kMostCpu = 3.0;             // 1.2 where it was measured; two threads draw

/// A pillow of 60 x 20 x 62 mm whose surface is as uneven as writing makes it.
TriMesh written_pillow(int around_count = kAround, int along_count = kAlong) {
  TriMesh mesh;
  for (int j = 0; j <= along_count; ++j)
    for (int i = 0; i < around_count; ++i) {
      const double along = 3.14159265358979 * j / along_count, around = 2 * 3.14159265358979 * i / around_count;
      const double relief = 1.0 + 0.01 * std::sin(40 * along) * std::sin(60 * around);
      mesh.positions.emplace_back(30 * relief * std::sin(along) * std::cos(around), 31 * relief * std::cos(along),
                                  10 * relief * std::sin(along) * std::sin(around));
    }
  const auto id = [=](int i, int j) { return static_cast<std::uint32_t>(j * around_count + i % around_count); };
  for (int j = 0; j < along_count; ++j)
    for (int i = 0; i < around_count; ++i) {
      mesh.triangles.push_back({id(i, j), id(i, j + 1), id(i + 1, j)});
      mesh.triangles.push_back({id(i + 1, j), id(i, j + 1), id(i + 1, j + 1)});
    }
  return mesh;
}

/// As a session with these options begins.
Shown shown_as(const StageOptions& options) {
  Shown out;
  out.style = options.shading.style;
  out.parts = options.shading.parts;
  return out;
}

FollowedEyes nobodys_eyes() {
  FollowedEyes out;
  out.presence = Presence::kOff;
  return out;
}

TEST(FirstPicture, OfAMillionVerticesOnFortyEightViewsIsLittleWork) {
  const TriMesh mesh = written_pillow();
  const auto context = EglContext::create();
  ASSERT_TRUE(context) << context.error().message;
  StageOptions options;
  options.display = testing::spec("quilt:looking-glass-portrait");
  options.quality = Quality::kAdaptive;
  options.samples = 2;
  options.shading = shading_preset("relief").value();
  const double before = process_cpu_seconds();
  auto stage = Stage::create(mesh, options).value();
  const SinkTraits traits = stage->traits();
  ASSERT_EQ(traits.views, 48);
  auto surface = OffscreenSurface::create(traits.output).value();
  const FollowedEyes eyes = nobodys_eyes();
  Shown shown = shown_as(options);
  stage->show(shown, eyes, 1);
  ASSERT_TRUE(stage->paint(surface.surface()));
  const Image picture = surface.read().value();
  const double cpu_s = process_cpu_seconds() - before;
  RecordProperty("cpu_ms", static_cast<int>(1e3 * cpu_s));
  EXPECT_LT(cpu_s, kMostCpu * testing::slowness()) << "of all threads together";
  EXPECT_EQ(stage->coarse_views(), 48);
  // Every tile shows the surface in its middle, and the background beside it.
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 8; ++column) {
      const int x = column * traits.view.width, y = row * traits.view.height;
      const auto* const middle = picture.at(x + traits.view.width / 2, y + traits.view.height / 2);
      EXPECT_NE(std::vector(middle, middle + 3), std::vector(picture.at(x + 4, y + 4), picture.at(x + 4, y + 4) + 3))
          << column << ", " << row;
    }
}

TEST(FirstPicture, TheExactOneComesInPiecesBetweenWhichNothingIsPainted) {
  const TriMesh mesh = written_pillow();
  const auto context = EglContext::create();
  ASSERT_TRUE(context) << context.error().message;
  StageOptions options;
  options.screen = {.window_w = 320, .window_h = 180};
  options.quality = Quality::kAdaptive;
  options.shading = shading_preset("relief").value();
  options.budget_ms = 0.0;  // pieces as small as they can be
  auto stage = Stage::create(mesh, options).value();
  auto surface = OffscreenSurface::create(stage->traits().output).value();
  const FollowedEyes eyes = nobodys_eyes();
  Shown shown = shown_as(options);
  TimestampNs now = 1;
  const auto step = [&] {
    now += 1'000'000'000;
    stage->show(shown, eyes, now);
  };
  step();
  ASSERT_TRUE(stage->paint(surface.surface()));
  const Image coarse = surface.read().value();
  int pieces = 0, paints = 0;
  while (stage->coarse_views() > 0) {
    step();
    if (!stage->work().value()) {  // the mesh is on its way
      std::this_thread::yield();
      continue;
    }
    ++pieces;
    paints += stage->needs_paint();
  }
  EXPECT_GT(pieces, 100) << "of 2.9 million triangles";
  EXPECT_EQ(paints, 0) << "half a picture is none";
  ASSERT_EQ(stage->coarse_views(), 0);
  EXPECT_TRUE(stage->needs_paint());
  ASSERT_TRUE(stage->paint(surface.surface()));
  EXPECT_FALSE(stage->needs_paint());
  EXPECT_NE(surface.read().value().pixels, coarse.pixels);
}

TEST(FirstPicture, OfAStyleThatTellsFiguresIsClayUntilTheyAreMeasured) {
  const TriMesh mesh = written_pillow(1200, 600);
  const auto context = EglContext::create();
  ASSERT_TRUE(context) << context.error().message;
  StageOptions options;
  options.screen = {.window_w = 320, .window_h = 180};
  options.quality = Quality::kAdaptive;
  options.shading = shading_preset("msii").value();
  auto stage = Stage::create(mesh, options).value();
  auto surface = OffscreenSurface::create(stage->traits().output).value();
  const FollowedEyes eyes = nobodys_eyes();
  Shown shown = shown_as(options);
  stage->show(shown, eyes, 1);
  ASSERT_TRUE(stage->paint(surface.surface()));
  ASSERT_TRUE(stage->measuring());
  // A lit body is not of one colour: its middle faces the eye, its rim does not.
  const Image picture = surface.read().value();
  int darkest = 255, brightest = 0;
  for (int y = 60; y < 120; ++y)
    for (int x = 120; x < 200; ++x) {
      darkest = std::min<int>(darkest, picture.at(x, y)[0]);
      brightest = std::max<int>(brightest, picture.at(x, y)[0]);
    }
  EXPECT_GT(brightest - darkest, 25);
  EXPECT_EQ(stage->still(1).error().kind, ErrorKind::kTryAgain) << "it would not be of the style";
  TimestampNs now = 1;
  while (stage->measuring()) {
    stage->show(shown, eyes, now += 1'000'000);
    std::this_thread::yield();
  }
  EXPECT_TRUE(stage->moved()) << "its colours are there now";
  EXPECT_TRUE(stage->still(1));
}

TEST(FirstPicture, TwoStatesBesideEachOtherComeInPiecesAndAreThoseOfOneGo) {
  const TriMesh mesh = written_pillow(600, 300);
  const auto context = EglContext::create();
  ASSERT_TRUE(context) << context.error().message;
  StageOptions options;
  options.screen = {.window_w = 320, .window_h = 180};
  options.shading = shading_preset("relief").value();
  const FollowedEyes eyes = nobodys_eyes();
  Shown shown = shown_as(options);
  auto other = std::make_shared<Shown>(shown);
  other->style = shading_preset("sky-sun").value().style;
  shown.parts[0].opacity = 0.5;
  shown.compared = other;
  Image whole;
  {
    auto stage = Stage::create(mesh, options).value();
    auto surface = OffscreenSurface::create(stage->traits().output).value();
    stage->show(shown, eyes, 1);
    ASSERT_TRUE(stage->paint(surface.surface()));
    whole = surface.read().value();
  }
  options.quality = Quality::kAdaptive;
  options.budget_ms = 0.0;
  auto stage = Stage::create(mesh, options).value();
  auto surface = OffscreenSurface::create(stage->traits().output).value();
  TimestampNs now = 1;
  int pieces = 0, seen = 0;
  stage->show(shown, eyes, now);
  ASSERT_TRUE(stage->paint(surface.surface()));
  while (stage->coarse_views() > 0) {
    now += 1'000'000'000;
    stage->show(shown, eyes, now);
    const int before = stage->coarse_views();
    if (!stage->work().value() && stage->coarse_views() == before) {
      std::this_thread::yield();
      continue;
    }
    ++pieces;
    seen += stage->needs_paint() ? 1 : 0;
    if (stage->needs_paint()) {
      ASSERT_TRUE(stage->paint(surface.surface()));
    }
  }
  EXPECT_GT(pieces, 80) << "of .36 million triangles, some of them several times";
  EXPECT_EQ(seen, 2) << "each half is seen when it is whole";
  EXPECT_EQ(surface.read().value().pixels, whole.pixels);
  // A glass over the middle of the present state shows it, whichever half was drawn last.
  stage->set_overlay_marks({Magnifier{{0.0, 0.0, 10.0}, 4.0, 0.3}, {}});
  ASSERT_TRUE(stage->paint(surface.surface()));
  const Image under = surface.read().value();
  const auto* const clay = under.at(3 * under.width / 4, under.height / 2);
  const auto* const ground = under.at(under.width / 2, 4);
  EXPECT_GT(clay[0] - ground[0], 30);
}

}  // namespace
}  // namespace dubsar::app
