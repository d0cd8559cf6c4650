// Where the camera stands and what it shows, against geometry by hand.

#include "display/render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "tests/display/ndc.h"

namespace dubsar {
namespace {

constexpr Box kTablet{{-20, -15, -5}, {20, 15, 5}};  // thin in z: right, up, front = x, y, z

ViewDirection direction(std::string_view text) { return parse_view_direction(text).value(); }

TEST(Camera, FrontShowsTheBroadFaceWithZUpWherePossible) {
  const struct {
    glm::dvec3 size, right, up, front;
  } cases[] = {{{6, 6, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
               {{6, 2, 5}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
               {{2, 6, 5}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
               {{3, 3, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
               {{2, 2, 3}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
  for (const auto& c : cases) {
    const ObjectFrame frame = object_frame({{0, 0, 0}, c.size});
    EXPECT_EQ(frame.right, c.right);
    EXPECT_EQ(frame.up, c.up);
    EXPECT_EQ(frame.front, c.front);
    EXPECT_EQ(glm::cross(frame.right, frame.up), frame.front) << "not right-handed";
  }
}

TEST(Camera, NamedViewsPutTheObjectsSidesWhereAViewerExpectsThem) {
  // Of each view: which object point is at the picture's right, at its top, and nearest.
  const struct {
    const char* name;
    glm::dvec3 right, up, near;
  } cases[] = {
      {"front", {20, 0, 0}, {0, 15, 0}, {0, 0, 5}},       {"back", {-20, 0, 0}, {0, 15, 0}, {0, 0, -5}},
      {"left", {0, 0, 5}, {0, 15, 0}, {-20, 0, 0}},       {"right", {0, 0, -5}, {0, 15, 0}, {20, 0, 0}},
      {"top", {20, 0, 0}, {0, 0, -5}, {0, 15, 0}},        {"bottom", {20, 0, 0}, {0, 0, 5}, {0, -15, 0}},
      {"orbit:90,0", {0, 0, -5}, {0, 15, 0}, {20, 0, 0}}, {"orbit:0,0,90", {0, 15, 0}, {-20, 0, 0}, {0, 0, 5}}};
  for (const auto& c : cases) {
    CameraOptions options;
    options.direction = direction(c.name);
    const View view = fit_camera(kTablet, options).value().view;
    const glm::dvec3 right = ndc(view, c.right), up = ndc(view, c.up), near = ndc(view, c.near);
    EXPECT_GT(right.x, 0.01) << c.name;
    EXPECT_EQ(right.y, 0) << c.name;
    EXPECT_GT(up.y, 0.01) << c.name;
    EXPECT_EQ(up.x, 0) << c.name;
    EXPECT_LT(near.z, ndc(view, -c.near).z) << c.name;
    EXPECT_EQ(near.x, 0) << c.name;
  }
}

TEST(Camera, OrthographicScaleIsExact) {
  CameraOptions options;
  options.mm_per_pixel = 25.4 / 600;
  options.width = 0;
  options.height = 0;
  options.margin = 0;
  const Camera camera = fit_camera(kTablet, options).value();
  EXPECT_EQ(camera.width, static_cast<int>(std::ceil(40 / options.mm_per_pixel)));
  EXPECT_EQ(camera.height, static_cast<int>(std::ceil(30 / options.mm_per_pixel)));
  EXPECT_EQ(camera.mm_per_pixel, options.mm_per_pixel);
  EXPECT_TRUE(camera.view.orthographic());
  const double pixels = (ndc(camera.view, {7, 0, 0}).x - ndc(camera.view, {-3, 0, 0}).x) / 2 * camera.width;
  EXPECT_NEAR(pixels, 10 / options.mm_per_pixel, 1e-9);
}

TEST(Camera, FittedObjectTouchesTheMarginAndNoMore) {
  for (const bool perspective : {false, true})
    for (const char* name : {"front", "left", "top", "orbit:37,21", "orbit:200,-65,12"}) {
      CameraOptions options;
      options.direction = direction(name);
      options.perspective = perspective;
      options.field_of_view_deg = 50;
      options.width = 640;
      options.height = 360;
      const Box box{{3, 4, 5}, {43, 34, 15}};
      const Camera camera = fit_camera(box, options).value();
      EXPECT_EQ(camera.view.orthographic(), !perspective);
      double extent = 0;
      for (int i = 0; i < 8; ++i) {
        const glm::dvec3 p = ndc(camera.view, {i & 1 ? 43 : 3, i & 2 ? 34 : 4, i & 4 ? 15 : 5});
        extent = std::max({extent, std::abs(p.x), std::abs(p.y)});
        EXPECT_LT(std::abs(p.z), 1) << name << " is cut by the near or far plane";
      }
      EXPECT_NEAR(extent, 1 - 2 * options.margin, 1e-9) << name << (perspective ? " perspective" : "");
    }
}

TEST(Camera, PixelsAreSquare) {
  for (const bool perspective : {false, true}) {
    CameraOptions options;
    options.perspective = perspective;
    options.width = 640;
    options.height = 360;
    const Camera camera = fit_camera(kTablet, options).value();
    EXPECT_NEAR(ndc(camera.view, {1, 0, 0}).x * 640, ndc(camera.view, {0, 1, 0}).y * 360, 1e-9);
    EXPECT_NEAR(ndc(camera.view, {1, 0, 0}).x * 320, 1 / camera.mm_per_pixel, 1e-9);
  }
}

TEST(Camera, ATileShowsTheSamePixelsAsTheWholePicture) {
  CameraOptions options;
  options.perspective = true;
  options.direction = direction("orbit:30,20");
  options.width = 640;
  options.height = 360;
  const View whole = fit_camera(kTablet, options).value().view;
  const View tile = crop_view(whole, 100, 40, 64, 32, 640, 360);
  for (const glm::dvec3 p : {glm::dvec3(0, 0, 0), glm::dvec3(11, -7, 3), glm::dvec3(-19, 2, -5)}) {
    const glm::dvec3 a = ndc(whole, p), b = ndc(tile, p);
    EXPECT_NEAR((b.x + 1) / 2 * 64 + 100, (a.x + 1) / 2 * 640, 1e-9);
    EXPECT_NEAR((b.y + 1) / 2 * 32 + 40, (a.y + 1) / 2 * 360, 1e-9);
    EXPECT_NEAR(b.z, a.z, 1e-12);
  }
}

TEST(Camera, WrongOptionsAreUsageErrors) {
  const auto kind = [](const Box& box, const CameraOptions& options) {
    const auto camera = fit_camera(box, options);
    return camera ? ErrorKind::kInternal : camera.error().kind;
  };
  EXPECT_EQ(kind({}, {}), ErrorKind::kUsage);
  EXPECT_EQ(kind({{0, 0, 0}, {1, NAN, 1}}, {}), ErrorKind::kUsage);
  EXPECT_EQ(kind(kTablet, {.margin = 0.5}), ErrorKind::kUsage);
  EXPECT_EQ(kind(kTablet, {.mm_per_pixel = -1}), ErrorKind::kUsage);
  EXPECT_EQ(kind(kTablet, {.perspective = true, .mm_per_pixel = 0.1}), ErrorKind::kUsage);
  EXPECT_EQ(kind(kTablet, {.perspective = true, .field_of_view_deg = 180}), ErrorKind::kUsage);
  EXPECT_EQ(kind(kTablet, {.width = 0}), ErrorKind::kUsage);
  EXPECT_EQ(kind(kTablet, {.mm_per_pixel = 1e-9, .width = 0, .height = 0}), ErrorKind::kUsage);
}

TEST(Camera, ViewNamesAreReadStrictly) {
  const ViewDirection d = direction("orbit:-30.5,20,7");
  EXPECT_EQ(d.azimuth_deg, -30.5);
  EXPECT_EQ(d.elevation_deg, 20);
  EXPECT_EQ(d.roll_deg, 7);
  EXPECT_EQ(direction("orbit:1,2").roll_deg, 0);
  for (const char* bad : {"", "Front", "orbit", "orbit:", "orbit:1", "orbit:1,", "orbit:1,2,", "orbit:1,2,3,4",
                          "orbit:a,b", "orbit:1,nan", "orbit:1;2", "orbit:1e300,0"}) {
    const auto result = parse_view_direction(bad);
    ASSERT_FALSE(result) << bad;
    EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace dubsar
