// Whole pictures against geometry: areas, scale, sides, colours.

#include "display/render/images/render_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr Rgb8 kNoLight{0, 0, 0};
constexpr std::array<Rgb8, 8> kFaceColors{Rgb8{255, 0, 0}, {0, 255, 0},   {0, 0, 255},     {255, 255, 0},
                                          {255, 0, 255},   {0, 255, 255}, {255, 255, 255}, {128, 128, 128}};

/// Vertex colours as they are.
RenderOptions flat_options(int width, int height) {
  RenderOptions options;
  options.camera.width = width;
  options.camera.height = height;
  options.shading = shading_preset("ao").value();
  options.shading.style.base_color = {255, 255, 255};
  options.shading.background.color = kNoLight;
  options.samples = 1;
  return options;
}

Picture render(const TriMesh& mesh, const RenderOptions& options) {
  SilentProgress progress;
  auto picture = render_picture(mesh, options, progress);
  EXPECT_TRUE(picture) << picture.error().message;
  return picture ? *picture : Picture{};
}

Rgb8 pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = image.at(x, y);
  return {p[0], p[1], p[2]};
}

double linear(double coded) { return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4); }
double coded(double value) {
  value = std::clamp(value, 0.0, 1.0);
  return value <= 0.0031308 ? value * 12.92 : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}

TEST(RenderImage, SilhouetteOfASphereHasTheAreaOfACircle) {
  RenderOptions options = flat_options(300, 300);
  options.samples = 4;
  options.shading.background.transparent = true;
  const Picture picture = render(testing::sphere(10, 128, 256), options);
  ASSERT_EQ(picture.image.channels, 4);
  double covered = 0;
  for (std::size_t i = 3; i < picture.image.pixels.size(); i += 4) covered += picture.image.pixels[i] / 255.0;
  const double area = covered * picture.mm_per_pixel * picture.mm_per_pixel;
  EXPECT_NEAR(area / (100 * std::numbers::pi), 1.0, 0.001);
}

TEST(RenderImage, LightOnASphereIsAnalytic) {
  RenderOptions options = flat_options(201, 201);
  options.shading = shading_preset("phong").value();
  options.shading.style.base_color = {200, 150, 100};
  const Shading& s = options.shading;
  const Picture picture = render(testing::sphere(10, 256, 512), options);
  const glm::dvec3 light = light_direction(s.light);
  for (const auto& [x, y] : {std::pair{100, 100}, {60, 70}, {100, 40}, {150, 120}}) {
    glm::dvec3 n((x - 100) * picture.mm_per_pixel / 10, (100 - y) * picture.mm_per_pixel / 10, 0);
    n.z = std::sqrt(1 - glm::dot(n, n));
    const double key = std::max(glm::dot(n, light), 0.0);
    const double gloss =
        key > 0 ? std::pow(std::max(glm::dot(n, glm::normalize(light + glm::dvec3(0, 0, 1))), 0.0), s.light.shininess)
                : 0;
    for (int c = 0; c < 3; ++c) {
      const double value =
          linear(s.style.base_color[c] / 255.0) * (s.light.ambient + s.light.key * key + s.light.fill * n.z) +
          s.light.specular * gloss;
      EXPECT_NEAR(pixel(picture.image, x, y)[c], 255 * coded(value), 1.0) << x << ", " << y << " channel " << c;
    }
  }
}

TEST(RenderImage, MissingNormalsAreComputed) {
  RenderOptions options = flat_options(120, 120);
  options.shading = shading_preset("phong").value();
  TriMesh mesh = testing::sphere(10, 128, 256);
  const Picture given = render(mesh, options);
  mesh.normals.clear();
  const Picture computed = render(mesh, options);
  int far_off = 0;
  for (std::size_t i = 0; i < given.image.pixels.size(); ++i)
    far_off += std::abs(given.image.pixels[i] - computed.image.pixels[i]) > 2;
  EXPECT_LT(far_off, 30);
}

TEST(RenderImage, EachNamedViewShowsItsFaceUprightAndNotMirrored) {
  const TriMesh mesh = testing::lettered_box();
  const char* names[] = {"front", "back", "left", "right", "top", "bottom"};
  const int sizes[][2] = {{400, 300}, {400, 300}, {100, 300}, {100, 300}, {400, 100}, {400, 100}};
  for (int face = 0; face < 6; ++face) {
    RenderOptions options = flat_options(sizes[face][0], sizes[face][1]);
    options.camera.direction = parse_view_direction(names[face]).value();
    options.camera.mm_per_pixel = 0.1;  // the face fills the picture
    color_partitions(options.shading.parts, kFaceColors);
    const Image image = render(mesh, options).image;
    int wrong = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double u = (x + 0.5) / image.width, v = 1 - (y + 0.5) / image.height;
        const bool stem = u > 0.3 && u < 0.4 && v > 0.2 && v < 0.8;
        const bool bars = u > 0.4 && v < 0.8 && ((u < 0.7 && v > 0.7) || (u < 0.55 && v > 0.45 && v < 0.55));
        wrong += pixel(image, x, y) != kFaceColors[stem || bars ? 6 : face];
      }
    EXPECT_EQ(wrong, 0) << names[face];
  }
}

TEST(RenderImage, OrthographicScaleIsExactInPixels) {
  RenderOptions options = flat_options(0, 0);
  options.camera.mm_per_pixel = 0.1;
  options.shading.background.transparent = true;
  const Picture picture = render(testing::lettered_box(), options);
  EXPECT_DOUBLE_EQ(picture.dpi(), 254.0);
  int left = picture.image.width, right = -1, top = picture.image.height, bottom = -1;
  for (int y = 0; y < picture.image.height; ++y)
    for (int x = 0; x < picture.image.width; ++x)
      if (picture.image.at(x, y)[3] == 255) {
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
  EXPECT_EQ(right - left + 1, 400);  // 40 mm
  EXPECT_EQ(bottom - top + 1, 300);
  EXPECT_EQ(left, picture.image.width - 1 - right) << "not centred";
}

TEST(RenderImage, AnisotropicVoxelsKeepTheirMillimetres) {
  TriMesh mesh = testing::lettered_box();
  mesh.frame.input_voxel.mm = {0.5, 1.0, 1.0};
  RenderOptions options = flat_options(200, 300);
  options.camera.mm_per_pixel = 0.1;
  const Image image = render(mesh, options).image;
  for (const auto& [x, y] : {std::pair{0, 0}, {199, 0}, {0, 299}, {199, 299}}) EXPECT_NE(pixel(image, x, y), kNoLight);
}

TEST(RenderImage, TilesFitTogether) {
  // 8 x 8 samples make tiles of 512 pixels: this picture has four.
  RenderOptions options = flat_options(800, 600);
  options.samples = 8;
  options.camera.mm_per_pixel = 0.05;
  color_partitions(options.shading.parts, kFaceColors);
  const Image image = render(testing::lettered_box(), options).image;
  int wrong = 0;
  for (int y = 0; y < 600; ++y)
    for (int x = 0; x < 800; ++x) {
      const bool stem = x >= 240 && x < 320 && y >= 120 && y < 480;
      const bool bars = x >= 320 && ((x < 560 && y >= 120 && y < 180) || (x < 440 && y >= 270 && y < 330));
      wrong += pixel(image, x, y) != kFaceColors[stem || bars ? 6 : 0];
    }
  EXPECT_EQ(wrong, 0);
}

TEST(RenderImage, HiddenPartitionsAreNotDrawnAndDoNotFrameThePicture) {
  TriMesh mesh;
  testing::add_rectangle(mesh, {-10, -10, 1}, {20, 0, 0}, {0, 20, 0}, 1);  // "envelope" before
  testing::add_rectangle(mesh, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 0);    // the smaller "tablet"
  RenderOptions options = flat_options(100, 100);
  options.camera.margin = 0.1;
  color_partitions(options.shading.parts, kFaceColors);
  EXPECT_EQ(pixel(render(mesh, options).image, 50, 50), kFaceColors[1]);
  show_partitions(options.shading.parts, 0b00000001);
  const Picture tablet = render(mesh, options);
  EXPECT_EQ(pixel(tablet.image, 50, 50), kFaceColors[0]);
  EXPECT_EQ(pixel(tablet.image, 10, 10), kFaceColors[0]);
  EXPECT_EQ(pixel(tablet.image, 9, 9), kNoLight);
  EXPECT_NEAR(tablet.mm_per_pixel, 10 / 80.0, 1e-9);

  SilentProgress progress;
  show_partitions(options.shading.parts, 0b00000100);
  const auto nothing = render_picture(mesh, options, progress);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().kind, ErrorKind::kUsage);
}

TEST(RenderImage, UnlitColoursAreThoseOfTheTable) {
  // A quad for every shape class at a few levels of ambient light.
  for (const char* preset : {"table", "black-white", "sky-sun", "ao", "table-ao", "sky-sun-ao", "black-white-ao"}) {
    TriMesh mesh;
    const std::array<int, 4> levels{0, 20, 41, 63};
    for (int shape = 0; shape < 127; ++shape)
      for (int a = 0; a < 4; ++a) {
        testing::add_rectangle(mesh, {shape, a, 0}, {1, 0, 0}, {0, 1, 0}, 0);
        mesh.shape.insert(mesh.shape.end(), 4, static_cast<std::uint8_t>(shape));
        mesh.ao.insert(mesh.ao.end(), 4, static_cast<std::uint8_t>(levels[a]));
      }
    RenderOptions options = flat_options(508, 16);
    options.shading = shading_preset(preset).value();
    options.shading.background.color = {1, 2, 3};
    options.camera.mm_per_pixel = 0.25;
    const Image image = render(mesh, options).image;
    const auto table = color_table(options.shading.style);
    for (int shape = 0; shape < 127; ++shape)
      for (int a = 0; a < 4; ++a) {
        const auto& entry = table[levels[a] * 128 + shape];
        EXPECT_EQ(pixel(image, 4 * shape + 2, 15 - (4 * a + 2)), (Rgb8{entry[0], entry[1], entry[2]}))
            << preset << " shape " << shape << " light " << levels[a];
      }
  }
}

TEST(RenderImage, ForeignColoursAreKept) {
  TriMesh mesh;
  testing::add_rectangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  mesh.colors.assign(4, {10, 120, 230});
  const RenderOptions options = flat_options(20, 20);
  EXPECT_EQ(pixel(render(mesh, options).image, 10, 10), (Rgb8{10, 120, 230}));
}

TEST(RenderImage, BackFacesAreShownTintedOrCulled) {
  TriMesh mesh;
  testing::add_rectangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  RenderOptions options = flat_options(20, 20);
  options.camera.direction = parse_view_direction("back").value();
  EXPECT_EQ(pixel(render(mesh, options).image, 10, 10), (Rgb8{255, 255, 255}));
  options.shading.style.back_faces = BackFaces::kTint;
  options.shading.style.back_color = {90, 30, 60};
  EXPECT_EQ(pixel(render(mesh, options).image, 10, 10), (Rgb8{90, 30, 60}));
  mesh.frame.scale.x = -1;  // turns the triangles the other way round, but not their outside
  EXPECT_EQ(pixel(render(mesh, options).image, 10, 10), (Rgb8{90, 30, 60}));
  mesh.frame.scale.x = 1;
  options.shading.style.back_faces = BackFaces::kCull;
  SilentProgress progress;
  const auto nothing = render_picture(mesh, options, progress);
  ASSERT_FALSE(nothing) << "a blank picture went unnoticed";
  EXPECT_EQ(nothing.error().kind, ErrorKind::kUnavailable);
}

TEST(RenderImage, TwoRunsGiveTheSameBytes) {
  RenderOptions options = flat_options(160, 120);
  options.shading = shading_preset("relief").value();
  options.samples = 2;
  options.camera.perspective = true;
  options.camera.direction = parse_view_direction("orbit:33,21").value();
  const TriMesh mesh = testing::lettered_box();
  EXPECT_EQ(render(mesh, options).image.pixels, render(mesh, options).image.pixels);
}

TEST(RenderImage, BackgroundAndTransparency) {
  RenderOptions options = flat_options(40, 40);
  options.shading.background.color = {12, 34, 56};
  const TriMesh mesh = testing::sphere(1, 16, 32);
  EXPECT_EQ(pixel(render(mesh, options).image, 0, 0), (Rgb8{12, 34, 56}));
  options.shading.background.transparent = true;
  const Image image = render(mesh, options).image;
  EXPECT_EQ(image.at(0, 0)[3], 0);
  EXPECT_EQ(image.at(20, 20)[3], 255);
  options.samples = 4;
  const Image smooth = render(mesh, options).image;
  for (std::size_t i = 0; i < smooth.pixels.size(); i += 4)
    ASSERT_TRUE(smooth.pixels[i + 3] == 0 || smooth.pixels[i] == 255) << "the background bleeds into the rim";
}

TEST(RenderImage, WrongRequestsAreRefusedWithTheRightKind) {
  SilentProgress progress;
  const auto kind = [&](const TriMesh& mesh, const RenderOptions& options) {
    const auto picture = render_picture(mesh, options, progress);
    return picture ? ErrorKind::kInternal : picture.error().kind;
  };
  const TriMesh mesh = testing::lettered_box();
  RenderOptions options = flat_options(20, 20);
  options.samples = 9;
  EXPECT_EQ(kind(mesh, options), ErrorKind::kUsage);
  EXPECT_EQ(kind(TriMesh(), flat_options(20, 20)), ErrorKind::kBadData);
  progress.cancel();
  EXPECT_EQ(kind(mesh, flat_options(20, 20)), ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
