// From the mesh to the panel's picture through whole sinks.

#include "display/sinks/render_display.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/vec4.hpp>

#include "display/render/images/test_pattern.h"
#include "display/sinks/output_sink.h"
#include "display/sinks/quilt.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr Screen kDrawnScreen{.width_mm = 100,
                              .height_mm = 60,
                              .width_px = 200,
                              .height_px = 120,
                              .window_x = 0,
                              .window_y = 0,
                              .window_w = 200,
                              .window_h = 120};

/// White on black, colours as they are.
DisplayOptions white_options() {
  DisplayOptions options;
  options.screen = kDrawnScreen;
  options.shading = shading_preset("ao").value();
  options.shading.style.base_color = {255, 255, 255};
  options.shading.background.color = {0, 0, 0};
  options.samples = 1;
  return options;
}

TriMesh card() {  // 40 x 20 mm, in one plane
  TriMesh mesh;
  testing::add_rectangle(mesh, {3, 4, 5}, {40, 0, 0}, {0, 20, 0}, 0);
  return mesh;
}

Image shown(const TriMesh& mesh, std::string_view display, const DisplayOptions& options) {
  SilentProgress progress;
  auto picture = render_display(mesh, testing::spec(display), options, progress);
  EXPECT_TRUE(picture) << picture.error().message;
  return picture ? std::move(picture->image) : Image();
}

/// Mean x of the bright pixels, and how many there are.
std::pair<double, int> bright(const Image& image) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (image.at(x, y)[0] > 127) sum += x + 0.5, ++count;
  return {count > 0 ? sum / count : NAN, count};
}

TEST(RenderDisplay, LifeSizeOnThePanelIsExact) {
  DisplayOptions options = white_options();
  options.magnification = 1;
  const Image image = shown(card(), "mono", options);
  EXPECT_EQ(bright(image).second, 80 * 40);  // 2 pixels a mm
  EXPECT_EQ(image.at(60, 40)[0], 255);
  EXPECT_EQ(image.at(59, 40)[0], 0);
  EXPECT_EQ(image.at(139, 79)[0], 255);
  EXPECT_EQ(image.at(140, 79)[0], 0);
}

TEST(RenderDisplay, FittedObjectsFillTheWindowToTheMargin) {
  DisplayOptions options = white_options();
  options.margin = 0.1;
  SilentProgress progress;
  const auto picture = render_display(card(), {"mono"}, options, progress);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_NEAR(picture->magnification, 80.0 / 40.0, 1e-9);
  EXPECT_EQ(bright(picture->image).second, 160 * 80);
}

TEST(RenderDisplay, DepthMovesTheEyesPicturesApartTheRightWay) {
  DisplayOptions options = white_options();
  options.magnification = 0.5;
  for (const double z : {-60.0, 0.0, 60.0}) {
    options.place_mm = {0, 0, z};
    const Image image = shown(card(), "side_by_side:full", options);
    Image left(200, 120, 3), right(200, 120, 3);
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 200; ++x) {
        std::copy_n(image.at(x, y), 3, left.at(x, y));
        std::copy_n(image.at(200 + x, y), 3, right.at(x, y));
      }
    // Similar triangles: disparity = ipd * z / (z - distance) in mm, 2 pixels a mm.
    EXPECT_NEAR(bright(right).first - bright(left).first, 2 * 63 * z / (z - 600), 1.01)
        << "half a pixel an eye; depth " << z;
  }
}

TEST(RenderDisplay, QuiltViewsSweepFromTheLeftmostCameraToTheRight) {
  DisplayOptions options = white_options();
  options.magnification = 0.3;
  options.place_mm = {0, 0, -20};
  const Image quilt = shown(card(), "quilt:columns=4,rows=2,width=320,height=120,aspect=1.5,cone=30", options);
  const auto views = split_quilt(quilt, {4, 2, 320, 120});
  for (std::size_t i = 1; i < views.size(); ++i)
    EXPECT_GT(bright(views[i]).first, bright(views[i - 1]).first + 0.2)
        << "what is behind the panel goes right with the camera, view " << i;
}

TEST(RenderDisplay, EverySinkThatDrawsShowsTheObject) {
  for (const SinkBackend& backend : output_sinks()) {
    if (backend.name == "null" || backend.name == "shutter" || backend.name == "image" ||
        backend.name == "lenticular" || backend.name == "openxr")
      continue;
    const bool quilt = backend.name == "quilt";
    const std::string spec = std::string(backend.name) + (quilt ? ":columns=3,rows=2,width=300,height=200" : "");
    DisplayOptions options = white_options();
    SilentProgress progress;
    const auto picture = render_display(testing::lettered_box(), testing::spec(spec), options, progress);
    if (!picture && picture.error().kind == ErrorKind::kUnavailable) continue;  // needs a stereo visual
    ASSERT_TRUE(picture) << spec << ": " << picture.error().message;
    EXPECT_EQ(picture->image.width, quilt ? 300 : 200) << spec;
    const int lit = bright(picture->image).second;
    EXPECT_GT(lit, picture->image.width * picture->image.height / 10) << spec;
    EXPECT_LT(lit, picture->image.width * picture->image.height) << spec;
  }
}

TEST(RenderDisplay, ObjectsAreTurnedAsTheViewSays) {
  const Box box{{-20, -15, -5}, {20, 15, 5}};
  const ViewDirection left = parse_view_direction("left").value();
  const glm::dmat4 m = place_object(box, left, {1, 2, 3}, 2);
  const auto at = [&](const glm::dvec3& p) { return glm::dvec3(m * glm::dvec4(p, 1)); };
  EXPECT_EQ(at({0, 0, 0}), glm::dvec3(1, 2, 3));
  EXPECT_EQ(at({-20, 0, 0}), glm::dvec3(1, 2, 43)) << "the left side faces the viewer";
  EXPECT_EQ(at({0, 0, 5}), glm::dvec3(11, 2, 3)) << "the front is at the right";
}

TEST(RenderDisplay, EachEyeSeesItsOwnPatternThroughTheLenses) {
  DisplayOptions options;
  const auto picture = render_pattern(testing::spec("lenticular:lens-sheet-24-5-views,nearest"), options);
  ASSERT_TRUE(picture) << picture.error().message;
  ASSERT_TRUE(picture->light);
  // Eyes in the middle of each view's cone, at the distance the panel is made for; 0 is the leftmost.
  const double distance = 298.8 / 2 / std::tan(7.0 * 3.14159265358979 / 180);
  for (int view = 0; view < 5; ++view) {
    const double angle = 20.0 * ((view + 0.5) / 5 - 0.5) * 3.14159265358979 / 180;
    const glm::dvec3 eye(distance * std::tan(angle), 0, distance);
    const EyeLight light = light_at(*picture->light, eye, 64);
    EXPECT_EQ(light.main_view, view);
    // A subpixel is a fifth of a lens wide and its slant adds a tenth: 6.25 % of an eye's light comes from beyond the
    // edge of the view it is in. For the outer views that is the sheet's other side; inner neighbours belong to the
    // same eye.
    if (view == 0 || view == 4) {
      EXPECT_NEAR(light.crosstalk, 0.0625, 0.005) << "view " << view;
      EXPECT_NEAR(light.crosstalk, light.shares[static_cast<std::size_t>(4 - view)], 1e-9)
          << "all of it is the other outer view";
    } else {
      EXPECT_LT(light.crosstalk, 0.001) << "view " << view;
    }
    if (view != 1) continue;
    const Image seen = see_display(*picture, eye).value();
    const Rgb8 expected = pattern_color(1, 5);  // yellow-green
    const std::uint8_t* ground = seen.at(1920 / 4, 1080 / 3);
    EXPECT_NEAR(ground[0], expected[0] / 2, 45);
    EXPECT_NEAR(ground[1], expected[1] / 2, 45);
    EXPECT_NEAR(ground[2], expected[2] / 2, 45);
  }
  EXPECT_EQ(see_display(*picture, {0, 0, -100}).error().kind, ErrorKind::kUsage);
}

TEST(RenderDisplay, TrackedWeaveIsSeenByTheEyesItWasWovenFor) {
  DisplayOptions options;
  options.viewer.left_mm = {-51.5, 10, 580};
  options.viewer.right_mm = {11.5, 10, 580};
  const auto picture = render_pattern(testing::spec("lenticular:spatiallabs-15.6"), options);
  ASSERT_TRUE(picture && picture->light);
  const EyeLight left = light_at(*picture->light, options.viewer.left_mm, 64);
  const EyeLight right = light_at(*picture->light, options.viewer.right_mm, 64);
  EXPECT_EQ(left.main_view, 0);
  EXPECT_EQ(right.main_view, 1);
  EXPECT_LT(left.crosstalk, 0.05);
  EXPECT_LT(right.crosstalk, 0.05);
}

TEST(RenderDisplay, SeeingIsForDisplaysWithLenses) {
  const auto picture = render_pattern({"anaglyph"}, DisplayOptions());
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(see_display(*picture, {0, 0, 600}).error().kind, ErrorKind::kUsage);
}

TEST(RenderDisplay, WrongRequestsAreUsageErrors) {
  SilentProgress progress;
  const auto kind = [&](std::string_view display, const DisplayOptions& options) {
    const auto picture = render_display(card(), testing::spec(display), options, progress);
    return picture ? ErrorKind::kInternal : picture.error().kind;
  };
  DisplayOptions options = white_options();
  EXPECT_EQ(kind("hologram", options), ErrorKind::kUsage);
  options.magnification = -1;
  EXPECT_EQ(kind("mono", options), ErrorKind::kUsage);
  options = white_options();
  show_partitions(options.shading.parts, 2);
  EXPECT_EQ(kind("mono", options), ErrorKind::kUsage);
  progress.cancel();
  EXPECT_EQ(kind("mono", white_options()), ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
