// Light that rakes, shadows, evidence, transparency: pictures against geometry.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <numbers>

#include "display/optics/srgb.h"
#include "display/render/context/context_egl.h"
#include "display/render/images/render_image.h"
#include "display/render/mesh/lod.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

/// A plate of 40 x 40 mm, 200 cells a side, with height z(x, y) over -20..20 mm.
template <class Height>
TriMesh relief(const Height& height) {
  constexpr int kCells = 400;
  TriMesh mesh;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x) {
      const double at_x = 40.0 * x / kCells - 20.0, at_y = 40.0 * y / kCells - 20.0;
      mesh.positions.emplace_back(at_x, at_y, height(at_x, at_y));
    }
  for (std::uint32_t y = 0; y < kCells; ++y)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t a = y * (kCells + 1) + x, b = a + 1, c = a + kCells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// Rows of shallow wedges: three-sided, 2.5 x 1.5 mm, 0.35 mm deep.
double wedges(double x, double y) {
  const double u = x - 4.0 * std::round(x / 4.0), v = y - 3.0 * std::round(y / 3.0);
  const double depth = 0.35 * (1.0 - std::max({std::abs(v) / 0.75, (u + 0.5) / 1.2, -(u + 0.5) / 0.7}));
  return -std::max(0.0, depth);
}

RenderOptions front(std::string_view style) {
  RenderOptions options;
  options.shading = shading_preset(style).value();
  options.camera.direction = {};
  options.camera.width = options.camera.height = 400;
  options.samples = 2;
  return options;
}

Image picture(const TriMesh& mesh, const RenderOptions& options) {
  SilentProgress silent;
  const auto made = render_picture(mesh, options, silent);
  EXPECT_TRUE(made) << made.error().message;
  return made ? made->image : Image(1, 1, 3);
}

/// Grey bytes of the middle of the picture, sorted.
std::vector<int> middle_greys(const Image& image) {
  std::vector<int> out;
  for (int y = image.height / 4; y < 3 * image.height / 4; ++y)
    for (int x = image.width / 4; x < 3 * image.width / 4; ++x) out.push_back(image.at(x, y)[1]);
  std::sort(out.begin(), out.end());
  return out;
}

int contrast(const std::vector<int>& greys) { return greys[greys.size() * 95 / 100] - greys[greys.size() * 5 / 100]; }

TEST(RakingLight, ShowsShallowWedgesWithThreeTimesTheContrastOfPlainLight) {
  const TriMesh mesh = relief(wedges);
  RenderOptions plain = front("phong"), raking = front("raking");
  for (RenderOptions* options : {&plain, &raking}) {
    options->shading.light.elevation_deg = 15;
    options->shading.light.azimuth_deg = 270;
  }
  const int before = contrast(middle_greys(picture(mesh, plain)));
  const int now = contrast(middle_greys(picture(mesh, raking)));
  EXPECT_GE(now, 3 * before) << now << " after " << before;
}

TEST(RakingLight, LevelClayIsAsBrightAtEveryElevation) {
  const TriMesh mesh = relief([](double, double) { return 0.0; });
  RenderOptions options = front("raking");
  std::vector<int> seen;
  for (const double elevation : {8.0, 15.0, 45.0, 90.0}) {
    options.shading.light.elevation_deg = elevation;
    const std::vector<int> greys = middle_greys(picture(mesh, options));
    EXPECT_EQ(greys.front(), greys.back()) << "a plane has no shadow on itself at " << elevation;
    seen.push_back(greys.front());
  }
  EXPECT_LE(*std::max_element(seen.begin(), seen.end()) - *std::min_element(seen.begin(), seen.end()), 1);
}

TEST(RakingLight, ShadowsOfAWallFallAwayFromTheLightAndAsFarAsItIsHigh) {
  // A post of 4 x 4 mm, 3 mm high: at 30 degrees its shadow is 3 / tan(30) = 5.2 mm long.
  const TriMesh mesh = relief([](double x, double y) { return std::max(std::abs(x), std::abs(y)) < 2.0 ? 3.0 : 0.0; });
  RenderOptions options = front("raking");
  options.camera.margin = 0.0;
  options.shading.light.elevation_deg = 30;
  for (int azimuth = 0; azimuth < 360; azimuth += 45) {
    options.shading.light.azimuth_deg = azimuth;
    const Image image = picture(mesh, options);
    const double rad = azimuth * std::numbers::pi / 180;
    const glm::dvec2 away(-std::sin(rad), -std::cos(rad));  // y up
    const auto grey = [&](const glm::dvec2& mm) {
      return image.at(static_cast<int>(200 + 10 * mm.x), static_cast<int>(200 - 10 * mm.y))[1];
    };
    const double reach = 2.0 / std::max(std::abs(away.x), std::abs(away.y));  // to the post's side, along `away`
    const double length = 3.0 / std::tan(std::numbers::pi / 6);
    const int lit = grey(-away * (reach + 3.0));
    EXPECT_GT(lit, 100) << "before the post, light from " << azimuth;
    EXPECT_LT(grey(away * (reach + 1.0)), 50) << "behind it, light from " << azimuth;
    // The far side of the post's top throws the end of the shadow.
    EXPECT_LT(grey(away * (reach + length - 0.6)), 60) << azimuth;
    EXPECT_NEAR(grey(away * (reach + length + 0.6)), lit, 3) << azimuth;
  }
}

TEST(RakingLight, TurnsOfTheViewTurnTheLightWithThem) {
  // Seen from behind, the light still comes from the left of the picture.
  TriMesh mesh = relief([](double x, double y) { return std::max(std::abs(x), std::abs(y)) < 2.0 ? -3.0 : 0.0; });
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);  // outside is below
  RenderOptions options = front("raking");
  options.camera.direction = parse_view_direction("back").value();
  options.camera.margin = 0.0;
  options.shading.light.azimuth_deg = 270;
  options.shading.light.elevation_deg = 30;
  const Image image = picture(mesh, options);
  EXPECT_LT(image.at(250, 200)[1], 60);
  EXPECT_GT(image.at(150, 200)[1], 100);
}

struct Lab {
  double l, a, b;
};
Lab lab(const std::array<double, 3>& linear) {
  const double x = (0.4124 * linear[0] + 0.3576 * linear[1] + 0.1805 * linear[2]) / 0.95047,
               y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2],
               z = (0.0193 * linear[0] + 0.1192 * linear[1] + 0.9505 * linear[2]) / 1.08883;
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  return {116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z))};
}

/// Mean colours of the left and the right half of the middle, and how much the right one varies in lightness.
std::pair<double, double> difference_of_halves(const Image& image) {
  std::array<std::array<double, 3>, 2> sum{};
  double low = 1e9, high = -1e9;
  for (int y = 150; y < 250; ++y)
    for (int x = 100; x < 300; ++x) {
      std::array<double, 3> pixel{};
      for (std::size_t c = 0; c < 3; ++c) {
        pixel[c] = linear_from_srgb(image.at(x, y)[c]);
        sum[x < 200 ? 0 : 1][c] += pixel[c] / 10000.0;
      }
      if (x < 200) continue;
      low = std::min(low, lab(pixel).l);
      high = std::max(high, lab(pixel).l);
    }
  const Lab a = lab(sum[0]), b = lab(sum[1]);
  return {std::sqrt(std::pow(a.l - b.l, 2) + std::pow(a.a - b.a, 2) + std::pow(a.b - b.b, 2)), high - low};
}

TEST(Evidence, WhatTheScanDoesNotShowIsHatchedInEveryStyle) {
  TriMesh mesh = relief([](double, double) { return 0.0; });
  for (const Triangle& t : mesh.triangles) mesh.triangle_inferred.push_back(mesh.positions[t[0]].x >= 0 ? 1 : 0);
  const auto context = EglContext::create().value();
  const LodMesh gpu = LodMesh::exact(pack_mesh(mesh).value()).value();
  auto renderer = Renderer::create().value();
  const Camera camera = fit_camera(gpu.box_mm(), {.width = 400, .height = 400}).value();
  for (const std::string_view style : shading_preset_names()) {
    Shading shading = shading_preset(style).value();
    auto array = ViewArray::create(400, 400, 1).value();
    ASSERT_TRUE(renderer.render(MeshScene(gpu, shading), std::span(&camera.view, 1), 1, array));
    const auto [marked, stripes] = difference_of_halves(array.read_layer(0).value());
    EXPECT_GE(marked, 20) << style;
    EXPECT_GE(stripes, 15) << style << ": the hatch";
    shading.style.mark_inferred = false;
    ASSERT_TRUE(renderer.render(MeshScene(gpu, shading), std::span(&camera.view, 1), 1, array));
    EXPECT_LT(difference_of_halves(array.read_layer(0).value()).first, 1) << style << ": switched off";
  }
}

TEST(Evidence, InferredTrianglesStayMarkedInEveryLevel) {
  TriMesh mesh = testing::sphere(20, 100, 200);
  std::vector<std::uint8_t>& inferred = mesh.triangle_inferred;
  for (const Triangle& t : mesh.triangles) inferred.push_back(mesh.positions[t[0]].z > 10 ? 1 : 0);
  PackedMesh packed = pack_mesh(mesh).value();
  EXPECT_EQ(packed.first_triangle[1] - packed.first_inferred[0], std::count(inferred.begin(), inferred.end(), 1));
  for (PackedMesh level : {cluster_vertices(packed, 1.0), quick_clusters(packed, 1.0)}) {
    ASSERT_LT(level.triangles.size(), packed.triangles.size() / 2);
    sort_into_chunks(level);
    std::int64_t marked = 0;
    for (const TriangleChunk& chunk : level.chunks) {
      marked += chunk.inferred ? chunk.count : 0;
      EXPECT_GT(chunk.box_mm.min.z, chunk.inferred ? 7 : -30);
      EXPECT_LT(chunk.box_mm.max.z, chunk.inferred ? 30 : 13);
    }
    EXPECT_EQ(marked, level.first_triangle[1] - level.first_inferred[0]);
    EXPECT_GT(marked, 0);
  }
  inferred.resize(3);
  EXPECT_FALSE(pack_mesh(mesh)) << "marks for a part of the triangles";
}

class Transparency : public ::testing::Test {
 protected:
  void SetUp() override { context_ = EglContext::create().value(); }
  std::unique_ptr<EglContext> context_;
};

TEST_F(Transparency, CrossingSheetsEqualFragmentsSortedOneByOne) {
  // Five tilted sheets that cross each other, drawn in an arbitrary order, over an opaque one.
  constexpr int kSide = 120;
  TriMesh mesh;
  const std::array<double, 6> tilts{0.0, 0.4, -0.6, 0.9, -0.2, 0.15}, heights{-20, 1, 2, -3, 0, 4};
  for (int p = 0; p < 6; ++p) {
    const double dz = p == 0 ? 0.0 : 40 * tilts[p], z = heights[p];
    testing::add_rectangle(mesh, {-20, -20, static_cast<float>(z - dz / 2)}, {40, 0, static_cast<float>(dz)},
                           {0, 40, 0}, static_cast<std::uint8_t>(p));
  }
  const LodMesh gpu = LodMesh::exact(pack_mesh(mesh).value()).value();
  Shading shading = shading_preset("ao").value();
  const std::array<Rgb8, 6> colors{Rgb8{200, 200, 200}, {255, 0, 0},   {0, 200, 50},
                                   {30, 60, 255},       {250, 220, 0}, {0, 200, 200}};
  const std::array<double, 6> opacity{1.0, 0.3, 0.5, 0.7, 0.2, 0.9};
  for (std::size_t p = 0; p < 6; ++p) {
    shading.parts[p].color = colors[p];
    shading.parts[p].opacity = opacity[p];
  }
  shading.background.color = {40, 80, 120};
  View view;
  view.clip_from_view = glm::ortho(-30.0, 30.0, -30.0, 30.0, -100.0, 100.0);
  auto renderer = Renderer::create().value();
  auto array = ViewArray::create(kSide, kSide, 1).value(), layers = ViewArray::create(kSide, kSide, 2).value();
  const auto drawn = renderer.render(MeshScene(gpu, shading), std::span(&view, 1), 1, array);
  ASSERT_TRUE(drawn) << drawn.error().message;
  const std::array<int, 1> second{1};
  ASSERT_TRUE(renderer.render_layers(MeshScene(gpu, shading), std::span(&view, 1), second, layers));
  const Image exact = array.read_layer(0).value(), quick = layers.read_layer(1).value();
  const auto linear = [](const Rgb8& c) {
    return glm::dvec3(linear_from_srgb(c[0]), linear_from_srgb(c[1]), linear_from_srgb(c[2]));
  };
  int off = 0, quick_off = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double mm = (x + 0.5) / 2 - 30, up = 30 - (y + 0.5) / 2;
      glm::dvec3 light = linear(shading.background.color);
      if (std::abs(mm) < 20 && std::abs(up) < 20) {
        std::array<std::pair<double, std::size_t>, 6> sheets;
        for (std::size_t p = 0; p < 6; ++p) sheets[p] = {heights[p] + (p == 0 ? 0.0 : tilts[p] * mm), p};
        std::sort(sheets.begin(), sheets.end());
        for (const auto& [z, p] : sheets)
          if (z >= heights[0]) light = glm::mix(light, linear(colors[p]), opacity[p]);
      }
      for (int c = 0; c < 3; ++c) {
        off += std::abs(exact.at(x, y)[c] - srgb_from_linear(light[c])) > 1;
        quick_off += std::abs(quick.at(x, y)[c] - srgb_from_linear(light[c])) > 1;
      }
    }
  EXPECT_EQ(off, 0);
  EXPECT_LE(quick_off, kSide * kSide * 3 / 100) << "8 bits of light between opaque and transparent";
}

TEST_F(Transparency, APartOfNoOpacityIsNotThereAndOneOfFullIsOpaque) {
  const LodMesh gpu = LodMesh::exact(pack_mesh(testing::lettered_box()).value()).value();
  const Camera camera = fit_camera(gpu.box_mm(), {.width = 60, .height = 60}).value();
  auto renderer = Renderer::create().value();
  const auto shown = [&](const Shading& shading) {
    auto array = ViewArray::create(60, 60, 1).value();
    EXPECT_TRUE(renderer.render(MeshScene(gpu, shading), std::span(&camera.view, 1), 2, array));
    return array.read_layer(0).value().pixels;
  };
  Shading whole = shading_preset("phong").value();
  color_partitions(whole.parts, distinct_partition_colors());
  Shading gone = whole, hidden = whole;
  gone.parts[0].opacity = 0.0;
  hidden.parts[0].visible = false;
  EXPECT_EQ(shown(gone), shown(hidden));
  EXPECT_TRUE(shown(gone) != shown(whole));
}

TEST_F(Transparency, FogGrowsFromTheNearestToTheFarthestPoint) {
  TriMesh mesh;
  testing::add_rectangle(mesh, {-20, -20, 0}, {20, 0, 0}, {0, 40, 0}, 0);
  testing::add_rectangle(mesh, {0, -20, -10}, {20, 0, 0}, {0, 40, 0}, 0);
  const LodMesh gpu = LodMesh::exact(pack_mesh(mesh).value()).value();
  Shading shading = shading_preset("ao").value();
  shading.background.color = {0, 0, 0};
  const MeshScene whole(gpu, shading);
  SceneView scene = whole;
  scene.fog.strength = 0.75;
  View view;
  view.clip_from_view = glm::ortho(-20.0, 20.0, -20.0, 20.0, -100.0, 100.0);
  auto renderer = Renderer::create().value();
  auto array = ViewArray::create(40, 40, 1).value();
  ASSERT_TRUE(renderer.render(scene, std::span(&view, 1), 1, array));
  const Image image = array.read_layer(0).value();
  EXPECT_EQ(image.at(10, 20)[0], 255);
  EXPECT_NEAR(image.at(30, 20)[0], srgb_from_linear(0.25), 1);
}

TEST(Growing, ACoarseMeshIsThereAtOnceAndTheExactOneSoonAfter) {
  const auto context = EglContext::create().value();
  const PackedMesh mesh = pack_mesh(testing::sphere(25, 500, 1000)).value();
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const auto before = threads();
  LodMesh lod = LodMesh::growing(mesh).value();
  EXPECT_EQ(threads(), before) << "nothing works beside the first picture";
  EXPECT_FALSE(lod.has_exact());
  EXPECT_EQ(lod.levels(), 1);
  EXPECT_LT(lod.triangles(0), static_cast<std::int64_t>(mesh.triangles.size()) / 2);
  EXPECT_EQ(lod.box_of(1).max.z, mesh.box_mm.max.z);
  bool finer = false;
  while (!lod.complete()) finer = lod.update().value() || finer;
  EXPECT_TRUE(finer && lod.has_exact());
  // As lod_mesh.h says: the mesh itself, then ever coarser grids that are worth their memory.
  std::vector<std::size_t> expected{mesh.triangles.size()};
  PackedMesh last = mesh;
  for (double grid = 1024; grid >= 63.9; grid *= 0.5 * std::numbers::sqrt2) {
    PackedMesh coarser = cluster_vertices(last, mesh.box_mm.size().z / grid);
    if (static_cast<double>(coarser.triangles.size()) > 0.75 * static_cast<double>(last.triangles.size())) continue;
    expected.push_back(coarser.triangles.size());
    last = std::move(coarser);
  }
  ASSERT_EQ(static_cast<std::size_t>(lod.levels()), expected.size());
  for (int i = 0; i < lod.levels(); ++i)  // a vertex on the border of two cells may fall into either
    EXPECT_NEAR(static_cast<double>(lod.triangles(i)), static_cast<double>(expected[i]),
                1e-3 * static_cast<double>(expected[i]))
        << i;
  LodMesh stopped = LodMesh::growing(mesh).value();  // goes while its thread works
  EXPECT_TRUE(stopped.update());
  EXPECT_EQ(threads(), before + 1);
}

}  // namespace
}  // namespace dubsar
