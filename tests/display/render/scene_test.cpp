// Scenes of several items against geometry: where lines, cuts and parts stand in the picture.

#include "display/render/scene.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "display/optics/srgb.h"
#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr int kSceneSide = 100;  // pixels; one mm each
constexpr Rgb8 kBlack{0, 0, 0}, kRed{255, 0, 0}, kGreen{0, 255, 0}, kWhite{255, 255, 255};

class Scene : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
    renderer_ = Renderer::create().value();
  }
  /// World x, y -50..50 in the picture, z -100..100 (the eye is at +z).
  static View view() {
    View out;
    out.clip_from_view = glm::ortho(-50.0, 50.0, -50.0, 50.0, -100.0, 100.0);
    return out;
  }
  static MeshItem plate(const LodMesh& mesh) {
    MeshItem item{&mesh, glm::dmat4(1.0), shading_preset("ao").value().style, {}};
    item.parts[0].color = kRed;
    item.parts[1].color = kGreen;
    return item;
  }
  /// Part 0: 40 x 40 mm at z = 0. Part 1: 20 x 20 mm at z = 10. Both around the middle.
  static LodMesh two_plates() {
    TriMesh mesh;
    testing::add_rectangle(mesh, {-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 0);
    testing::add_rectangle(mesh, {-10, -10, 10}, {20, 0, 0}, {0, 20, 0}, 1);
    return LodMesh::exact(pack_mesh(mesh).value()).value();
  }
  Image picture(std::span<const DrawItem> items, std::span<const ClipPlane> clips = {}, int factor = 1) {
    const SceneView scene{items, Light(), clips, Background{kBlack, false}};
    const View eye = view();
    auto array = ViewArray::create(kSceneSide, kSceneSide, 1).value();
    const auto drawn = renderer_.render(scene, std::span(&eye, 1), factor, array);
    EXPECT_TRUE(drawn) << drawn.error().message;
    const Image one = array.read_layer(0).value();
    if (factor == 1) {  // in layers, too
      auto layers = ViewArray::create(kSceneSide, kSceneSide, 3).value();
      const std::array<View, 2> eyes{eye, eye};
      const std::array<int, 2> where{2, 0};
      EXPECT_TRUE(renderer_.render_layers(scene, eyes, where, layers));
      for (const int layer : where) {
        const Image other = layers.read_layer(layer).value();
        int off = 0;
        for (std::size_t i = 0; i < one.pixels.size(); ++i) off += std::abs(one.pixels[i] - other.pixels[i]) > 1;
        EXPECT_EQ(off, 0) << "layer " << layer;
      }
    }
    return one;
  }
  /// At world x, y.
  static Rgb8 at(const Image& image, double x, double y) {
    const std::uint8_t* p = image.at(static_cast<int>(x + 50), static_cast<int>(50 - y));
    return {p[0], p[1], p[2]};
  }

  std::unique_ptr<EglContext> context_;
  Renderer renderer_;
};

TEST_F(Scene, PartsStandWhereTheirOffsetsPutThem) {
  const LodMesh mesh = two_plates();
  MeshItem item = plate(mesh);
  const DrawItem before = item;
  EXPECT_EQ(at(picture(std::span(&before, 1)), 0.5, 0.5), kGreen);
  item.parts[1].offset_mm = {25, 0, 0};
  const DrawItem moved = item;
  const Image image = picture(std::span(&moved, 1));
  EXPECT_EQ(at(image, 0.5, 0.5), kRed);
  EXPECT_EQ(at(image, 34.5, 9.5), kGreen);
  EXPECT_EQ(at(image, 35.5, 0.5), kBlack);
  const SceneView scene{std::span(&moved, 1), {}, {}, {}};
  EXPECT_NEAR(scene_box_mm(scene).max.x, 35, 1e-9);
  item.parts[1].visible = false;
  const DrawItem hidden = item;
  EXPECT_EQ(at(picture(std::span(&hidden, 1)), 34.5, 9.5), kBlack);
}

TEST_F(Scene, AMeshIsTurnedScaledAndMovedAsItsItemSays) {
  const LodMesh mesh = two_plates();
  MeshItem item = plate(mesh);
  item.parts[1].visible = false;
  item.world_from_model = glm::scale(glm::translate(glm::dmat4(1.0), {10, 0, 0}), glm::dvec3(0.5));
  const DrawItem placed = item;
  const Image image = picture(std::span(&placed, 1));
  EXPECT_EQ(at(image, 0.5, 0.5), kRed);
  EXPECT_EQ(at(image, -0.5, 0.5), kBlack);
  EXPECT_EQ(at(image, 19.5, 9.5), kRed);
  EXPECT_EQ(at(image, 20.5, 9.5), kBlack);
}

TEST_F(Scene, PlanesCutMeshesButNotLines) {
  const LodMesh mesh = two_plates();
  LinesItem line;
  line.points_mm = {{-40, 30, 0}, {40, 30, 0}};
  const std::array<DrawItem, 2> items{plate(mesh), line};
  const std::array<ClipPlane, 2> clips{ClipPlane{{5, 0, 0}, {-1, 0, 0}}, ClipPlane{{0, 0, 8}, {0, 0, -1}}};
  const Image cut = picture(items, clips);
  EXPECT_EQ(at(cut, 0.5, 0.5), kRed) << "part 1 lies before the second plane";
  EXPECT_EQ(at(cut, 4.5, 15.5), kRed);
  EXPECT_EQ(at(cut, 5.5, 15.5), kBlack);
  EXPECT_EQ(at(cut, 30.5, 30.5), kWhite);
  EXPECT_EQ(at(picture(items), 5.5, 15.5), kRed) << "without planes nothing is cut";
}

TEST_F(Scene, LinesHaveTheirWidthAndHideBehindSurfaces) {
  const LodMesh mesh = two_plates();
  LinesItem line;
  line.points_mm = {{-40, 0, 5}, {40, 0, 5}};
  line.width_px = 4;
  line.lift_mm = 0;
  std::array<DrawItem, 2> items{line, plate(mesh)};
  const auto width_at = [](const Image& image, int column) {
    int out = 0;
    for (int y = 0; y < kSceneSide; ++y) out += image.at(column, y)[2] > 128;
    return out;
  };
  const Image one = picture(items), finer = picture(items, {}, 3);
  EXPECT_EQ(width_at(one, 15), 4);
  EXPECT_EQ(width_at(finer, 15), 4) << "in pixels of the picture, whatever the samples";
  EXPECT_EQ(width_at(one, 35), 4) << "before part 0";
  EXPECT_EQ(at(one, 0.5, 0.5), kGreen) << "behind part 1";
  EXPECT_EQ(at(one, 42.5, 0.5), kBlack);
  line.hidden_opacity = 0.5;
  items[0] = line;
  const Rgb8 faint = at(picture(items), 0.5, 0.5);
  EXPECT_NEAR(faint[0], srgb_from_linear(0.5), 1);
  EXPECT_EQ(faint[1], 255);
  line.lift_mm = 6;
  items[0] = line;
  EXPECT_EQ(at(picture(items), 0.5, 0.5), kWhite) << "lifted before part 1";
}

TEST_F(Scene, ALineThatBeginsBehindTheEyeIsCutAtTheNearPlane) {
  View eye;
  eye.clip_from_view = glm::frustum(-1.0, 1.0, -1.0, 1.0, 10.0, 200.0);
  LinesItem line;
  line.points_mm = {{0, -5, 30}, {0, -5, -100}};  // from behind the eye to 100 mm before it
  const DrawItem item = line;
  const SceneView scene{std::span(&item, 1), {}, {}, Background{kBlack, false}};
  auto array = ViewArray::create(kSceneSide, kSceneSide, 1).value();
  ASSERT_TRUE(renderer_.render(scene, std::span(&eye, 1), 1, array));
  const Image image = array.read_layer(0).value();
  EXPECT_EQ(at(image, 0.5, -25.5), kWhite) << "y = -5 at 20 mm is half of the lower half";
  EXPECT_EQ(at(image, 0.5, -49.5), kWhite) << "it leaves the picture at 50 mm / 10";
  EXPECT_EQ(at(image, 0.5, 10.5), kBlack);
}

TEST_F(Scene, WhatCannotBeDrawnIsRefused) {
  const auto refused = [&](const DrawItem& item) {
    const auto checked = check_scene({std::span(&item, 1), {}, {}, {}});
    return !checked && checked.error().kind == ErrorKind::kUsage;
  };
  EXPECT_TRUE(refused(MeshItem{}));
  LinesItem line;
  line.points_mm = {{0, 0, 0}};
  EXPECT_TRUE(refused(line));
  line.points_mm = {{0, 0, 0}, {NAN, 0, 0}};
  EXPECT_TRUE(refused(line));
  line.points_mm = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(refused(line));
  line.opacity = 1.5;
  EXPECT_TRUE(refused(line));
  const std::vector<ClipPlane> planes(9);
  EXPECT_FALSE(check_scene({{}, {}, planes, {}}));
}

}  // namespace
}  // namespace dubsar
