// Many views into the layers of a view array.

#include "display/render/renderer.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include "display/render/camera.h"
#include "display/render/context/context_egl.h"
#include "display/render/context/embedded_shaders.h"
#include "display/render/mesh/lod_mesh.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

class RendererTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
  }
  std::unique_ptr<EglContext> context_;
};

TEST_F(RendererTest, EachLayerShowsItsOwnView) {
  const TriMesh mesh = testing::lettered_box();
  auto gpu = LodMesh::exact(pack_mesh(mesh).value());
  auto renderer = Renderer::create();
  ASSERT_TRUE(gpu && renderer);
  std::vector<View> views;
  for (const char* name : {"front", "orbit:40,10", "top", "left", "orbit:-100,-30"}) {
    CameraOptions options;
    options.direction = parse_view_direction(name).value();
    options.width = 64;
    options.height = 48;
    views.push_back(fit_camera(gpu->box_mm(), options).value().view);
  }
  const Shading shading = shading_preset("phong").value();
  auto all = ViewArray::create(64, 48, 7);
  ASSERT_TRUE(all);
  ASSERT_TRUE(renderer->render(MeshScene(*gpu, shading), views, 2, *all, 1));
  for (std::size_t i = 0; i < views.size(); ++i) {
    auto one = ViewArray::create(64, 48, 1);
    ASSERT_TRUE(renderer->render(MeshScene(*gpu, shading), std::span(&views[i], 1), 2, *one));
    EXPECT_EQ(all->read_layer(static_cast<int>(i) + 1)->pixels, one->read_layer(0)->pixels) << "view " << i;
    EXPECT_NE(all->read_layer(static_cast<int>(i))->pixels, all->read_layer(static_cast<int>(i) + 1)->pixels);
  }
}

TEST_F(RendererTest, ShadowsAreThoseOfTheMeshThatIsThereAndNotOfOneThatWasAtItsPlaceInMemory) {
  const auto post_at = [](float x) {  // a plate with a post on it, as many triangles wherever the post stands
    TriMesh mesh;
    testing::add_rectangle(mesh, {-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 0);
    for (const float side : {-1.0f, 1.0f})
      testing::add_rectangle(mesh, {x, -3 * side, 0}, {0, 6 * side, 0}, {0, 0, 8}, 0);
    return mesh;
  };
  Shading shading = shading_preset("raking").value();
  shading.light.azimuth_deg = 270;
  CameraOptions camera;
  camera.width = camera.height = 64;
  std::optional<LodMesh> mesh = LodMesh::exact(pack_mesh(post_at(-8)).value()).value();
  const View view = fit_camera(mesh->box_mm(), camera).value().view;
  auto array = ViewArray::create(64, 64, 1).value();
  auto used = Renderer::create().value(), fresh = Renderer::create().value();
  ASSERT_TRUE(used.render(MeshScene(*mesh, shading), std::span(&view, 1), 1, array));
  const Image first = array.read_layer(0).value();
  mesh.emplace(LodMesh::exact(pack_mesh(post_at(4)).value()).value());
  ASSERT_TRUE(used.render(MeshScene(*mesh, shading), std::span(&view, 1), 1, array));
  const Image second = array.read_layer(0).value();
  ASSERT_TRUE(fresh.render(MeshScene(*mesh, shading), std::span(&view, 1), 1, array));
  EXPECT_EQ(second.pixels, array.read_layer(0)->pixels);
  EXPECT_NE(second.pixels, first.pixels);
}

TEST_F(RendererTest, ShadowsOfMovingThingsFallWhereThoseAtRestDo) {
  // A post of 6 x 6 mm, 6 mm high: at 30 degrees its shadow is 10.4 mm long.
  constexpr int kSide = 400;  // pixels, 10 a mm
  TriMesh mesh;
  testing::add_rectangle(mesh, {-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 0);
  testing::add_rectangle(mesh, {-3, -3, 6}, {6, 0, 0}, {0, 6, 0}, 0);
  for (const float side : {-1.0f, 1.0f}) {
    testing::add_rectangle(mesh, {3 * side, -3 * side, 0}, {0, 6 * side, 0}, {0, 0, 6}, 0);
    testing::add_rectangle(mesh, {-3 * side, -3 * side, 0}, {6 * side, 0, 0}, {0, 0, 6}, 0);
  }
  const LodMesh gpu = LodMesh::exact(pack_mesh(mesh).value()).value();
  View view;
  view.clip_from_view = glm::ortho(-20.0, 20.0, -20.0, 20.0, -100.0, 100.0);
  auto renderer = Renderer::create().value();
  auto array = ViewArray::create(kSide, kSide, 1).value();
  Shading shading = shading_preset("raking").value();
  shading.light.elevation_deg = 30;
  const int layer = 0;
  for (const double coarse_px : {1.5, 12.0})  // the finest and the coarsest of moving pictures
    for (const int azimuth : {0, 60, 90, 150, 225, 270}) {
      shading.light.azimuth_deg = azimuth;
      const MeshScene scene(gpu, shading);
      ASSERT_TRUE(renderer.render(scene, std::span(&view, 1), 1, array));
      const Image rest = array.read_layer(0).value();
      ASSERT_TRUE(renderer.render_layers(scene, std::span(&view, 1), std::span(&layer, 1), array, coarse_px));
      const Image moving = array.read_layer(0).value();
      int dark = 0, other = 0, inside = 0;
      const auto is_dark = [](const Image& image, int x, int y) { return image.at(x, y)[1] < 60; };
      for (int y = 3; y < kSide - 3; ++y)
        for (int x = 3; x < kSide - 3; ++x) {
          const bool shaded = is_dark(rest, x, y);
          dark += shaded;
          if (shaded == is_dark(moving, x, y)) continue;
          ++other;
          bool rim = false;  // within 3 pixels, 0.3 mm, of the shadow's edge
          for (int dy = -3; dy <= 3; ++dy)
            for (int dx = -3; dx <= 3; ++dx) rim = rim || is_dark(rest, x + dx, y + dy) != shaded;
          inside += !rim;
        }
      EXPECT_GT(dark, 3000) << azimuth;
      EXPECT_EQ(inside, 0) << azimuth << " merging " << coarse_px;
      EXPECT_LT(other, dark / 10) << azimuth << " merging " << coarse_px;
    }
}

TEST_F(RendererTest, LayersKeepWhatIsWrittenTopRowFirst) {
  auto array = ViewArray::create(3, 2, 2);
  ASSERT_TRUE(array);
  Image image(3, 2, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<std::uint8_t>(11 * i);
  ASSERT_TRUE(array->write_layer(1, image));
  EXPECT_EQ(array->read_layer(1)->pixels, image.pixels);
}

TEST_F(RendererTest, ImpossibleArraysAreUsageErrors) {
  for (const auto& [w, h, layers] : {std::array{0, 1, 1}, {1, 1 << 20, 1}, {1, 1, 0}, {1, 1, 1 << 20}}) {
    const auto array = ViewArray::create(w, h, layers);
    ASSERT_FALSE(array);
    EXPECT_EQ(array.error().kind, ErrorKind::kUsage);
  }
}

TEST_F(RendererTest, NoSurfaceContextIsGl45AndNamesItself) {
  EXPECT_TRUE(has_gl45());
  EXPECT_NE(describe_gl().find("OpenGL 4."), std::string::npos) << describe_gl();
}

TEST(Shaders, AreEmbeddedUnderTheirNames) {
  std::set<std::string_view> names;
  for (const auto& [name, text] : embedded_shaders()) {
    EXPECT_EQ(text.starts_with("#version 450 core"), !name.ends_with(".glsl")) << name << ": parts have no version";
    names.insert(name);
  }
  EXPECT_TRUE(names.contains("mesh.vert") && names.contains("mesh.frag"));
}

}  // namespace
}  // namespace dubsar
