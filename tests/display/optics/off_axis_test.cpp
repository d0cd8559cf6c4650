// Off-axis cameras: invariants of a window that eyes look through.

#include "display/optics/off_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/vec4.hpp>
#include <numbers>

#include "tests/display/ndc.h"

namespace dubsar {
namespace {

constexpr Screen kScreen{.width_mm = 400,
                         .height_mm = 200,
                         .width_px = 2000,
                         .height_px = 1000,
                         .window_x = 0,
                         .window_y = 0,
                         .window_w = 2000,
                         .window_h = 1000};

TEST(OffAxis, PointsOnThePanelAreSeenAtTheSamePlaceByEveryEye) {
  const WindowRect window = kScreen.window_rect();
  for (const glm::dvec3 eye : {glm::dvec3(0, 0, 600), {-31.5, 10, 600}, {250, -90, 400}, {-700, 300, 150}}) {
    const View view = off_axis_view(window, eye, 100, 2000);
    for (const glm::dvec3 p : {glm::dvec3(0, 0, 0), {-200, -100, 0}, {200, 100, 0}, {37, -81, 0}}) {
      EXPECT_NEAR(ndc(view, p).x, p.x / 200, 1e-12);
      EXPECT_NEAR(ndc(view, p).y, p.y / 100, 1e-12);
    }
  }
}

TEST(OffAxis, AnyPointIsSeenWhereItsRayCrossesThePanel) {
  const glm::dvec3 eye(80, -40, 500), p(-60, 30, -250);
  const glm::dvec3 crossing = eye + (p - eye) * (eye.z / (eye.z - p.z));
  const glm::dvec3 seen = ndc(off_axis_view(kScreen.window_rect(), eye, 100, 2000), p);
  EXPECT_NEAR(seen.x, crossing.x / 200, 1e-12);
  EXPECT_NEAR(seen.y, crossing.y / 100, 1e-12);
}

TEST(OffAxis, ATiltedWindowWorksLikeAnUprightOne) {
  // Turn window, eye and point about an axis: what is seen does not change.
  const glm::dmat4 turn = glm::translate(glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3)), glm::dvec3(40, 50, 60));
  const auto turned = [&](const glm::dvec3& p) { return glm::dvec3(turn * glm::dvec4(p, 1)); };
  const WindowRect w = kScreen.window_rect();
  const glm::dvec3 eye(80, -40, 500), p(-60, 30, -250);
  const glm::dvec3 upright = ndc(off_axis_view(w, eye, 100, 2000), p);
  const View view =
      off_axis_view({turned(w.lower_left), turned(w.lower_right), turned(w.upper_left)}, turned(eye), 100, 2000);
  EXPECT_NEAR(glm::length(ndc(view, turned(p)) - upright), 0, 1e-9);
}

TEST(OffAxis, AWindowShowsItsPartOfTheWholePanel) {
  Screen screen = kScreen;
  screen.window_x = 300;
  screen.window_y = 100;
  screen.window_w = 500;
  screen.window_h = 250;
  const glm::dvec3 eye(80, -40, 500), p(-90, 50, -100);
  const glm::dvec3 whole = ndc(off_axis_view(kScreen.window_rect(), eye, 100, 2000), p);
  const glm::dvec3 part = ndc(off_axis_view(screen.window_rect(), eye, 100, 2000), p);
  EXPECT_NEAR((part.x + 1) / 2 * 500 + 300, (whole.x + 1) / 2 * 2000, 1e-9);
  EXPECT_NEAR((1 - part.y) / 2 * 250 + 100, (1 - whole.y) / 2 * 1000, 1e-9);
}

TEST(OffAxis, LookingGlassCamerasAreTheSpecialCase) {
  // displays: P[2][0] = -off / (size * aspect), off = distance * tan(angle).
  const double size = 80, aspect = 0.75, distance = size / std::tan(7 * std::numbers::pi / 180);
  const WindowRect window{{-size * aspect, -size, 0}, {size * aspect, -size, 0}, {-size * aspect, size, 0}};
  const auto eyes = cone_eyes(5, 40 * std::numbers::pi / 180, distance);
  ASSERT_EQ(eyes.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const double angle = std::atan2(eyes[i].x, eyes[i].z) * 180 / std::numbers::pi;
    EXPECT_NEAR(angle, -16 + 8 * i, 1e-9) << "view 0 is the leftmost camera";
    const View view = off_axis_view(window, eyes[i], 0.8 * distance, 1.2 * distance);
    EXPECT_NEAR(view.clip_from_view[2][0], -eyes[i].x / (size * aspect), 1e-12);
    EXPECT_NEAR(view.clip_from_view[2][1], 0, 1e-12);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(view.view_from_world[c][r], r == c ? 1 : 0) << "cameras must not toe in";
  }
}

TEST(OffAxis, EyesInOrBehindThePanelAreMovedBeforeIt) {
  for (const double z : {0.0, -50.0, 3.0, static_cast<double>(NAN)}) {
    const View view = off_axis_view(kScreen.window_rect(), {10, 0, z}, 1, 100);
    const glm::dvec3 seen = ndc(view, {10, 0, 0});
    if (std::isnan(z)) continue;
    EXPECT_NEAR(seen.x, 0.05, 1e-9);
    EXPECT_TRUE(std::isfinite(seen.z));
  }
}

TEST(Observer, FactorsScaleTheEyesAndTheirWay) {
  Observer viewer;
  viewer.left_mm = {68.5, 20, 500};
  viewer.right_mm = {131.5, 20, 500};
  CameraPair pair = camera_pair(viewer);
  EXPECT_EQ(pair.left_mm, viewer.left_mm);
  EXPECT_EQ(pair.right_mm, viewer.right_mm);
  viewer.ipd_factor = 0;
  EXPECT_EQ(camera_pair(viewer).left_mm, camera_pair(viewer).right_mm);
  viewer.ipd_factor = 0.5;
  viewer.parallax_factor = 0;
  pair = camera_pair(viewer);
  EXPECT_EQ(pair.centre_mm(), viewer.nominal_mm);
  EXPECT_EQ(pair.right_mm.x - pair.left_mm.x, 31.5);
}

TEST(Observer, HeadToTheRightMovesWhatIsBehindThePanelToTheRight) {
  Observer viewer;
  const glm::dvec3 behind(0, 0, -100), before(0, 0, 100);
  const auto seen = [&](double head_x, const glm::dvec3& p) {
    return ndc(viewer_view(kScreen.window_rect(), viewer, {head_x, 0, 600}), p).x;
  };
  EXPECT_GT(seen(50, behind), seen(0, behind));
  EXPECT_LT(seen(50, before), seen(0, before));
  EXPECT_EQ(seen(0, behind), 0);
}

TEST(Observer, ZeroParallaxPlaneAndDepthFactorPlaceTheScene) {
  Observer viewer;
  viewer.zero_parallax_mm = -40;
  const WindowRect window = kScreen.window_rect();
  const auto disparity = [&](double z) {
    return ndc(viewer_view(window, viewer, viewer.right_mm), {0, 0, z}).x -
           ndc(viewer_view(window, viewer, viewer.left_mm), {0, 0, z}).x;
  };
  EXPECT_NEAR(disparity(-40), 0, 1e-12);
  EXPECT_GT(disparity(-80), 0.001) << "behind the panel the right eye sees it further right";
  EXPECT_LT(disparity(0), -0.001);
  viewer.depth_factor = 0;
  EXPECT_NEAR(disparity(-80), 0, 1e-12);
}

TEST(Observer, ClipPlanesHoldTheScene) {
  Observer viewer;
  viewer.front_mm = 120;
  viewer.back_mm = -300;
  viewer.zero_parallax_mm = 10;
  viewer.depth_factor = 1.5;
  const View view = viewer_view(kScreen.window_rect(), viewer, {0, 0, 600});
  EXPECT_NEAR(ndc(view, {0, 0, 120}).z, -1, 1e-9);
  EXPECT_NEAR(ndc(view, {0, 0, -300}).z, 1, 1e-9);
}

TEST(ViewFocus, CamerasMoveAsPicturesDo) {
  const ViewFocus focus{0.03, 1.7};
  const glm::dvec3 point(12, -7, 40);
  const auto uv = [&](const View& view) { return 0.5 + 0.5 * glm::dvec2(ndc(view, point)); };
  for (int i = 0; i < 5; ++i) {
    const View plain = viewer_view(kScreen.window_rect(), {}, {20.0 * i - 40, 0, 600});
    const glm::dvec2 from = focus_source(focus, i, 5, uv(focused_view(plain, focus, i, 5)));
    EXPECT_NEAR(from.x, uv(plain).x, 1e-12);
    EXPECT_NEAR(from.y, uv(plain).y, 1e-12);
  }
  EXPECT_EQ(focus_source({}, 3, 5, {0.2, 0.9}), glm::dvec2(0.2, 0.9));
  EXPECT_LT(uv(focused_view(viewer_view(kScreen.window_rect(), {}, {40, 0, 600}), {0.1, 1}, 4, 5)).x,
            uv(viewer_view(kScreen.window_rect(), {}, {40, 0, 600})).x)
      << "above 0: the right eye sees it farther to the left, so that it comes nearer";
}

TEST(Screen, NonsenseIsRefused) {
  EXPECT_TRUE(check_screen(kScreen));
  Screen screen = kScreen;
  screen.width_mm = 0;
  EXPECT_EQ(check_screen(screen).error().kind, ErrorKind::kUsage);
  screen = kScreen;
  screen.window_h = 0;
  EXPECT_EQ(check_screen(screen).error().kind, ErrorKind::kUsage);
  screen = kScreen;
  screen.height_mm = NAN;
  EXPECT_EQ(check_screen(screen).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
