// What planes cut through is filled: areas, depths and colours of sections of bodies that are known.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <numbers>

#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr int kSectionSide = 400;
constexpr double kHalf = 12.0;  // mm of the world across the picture, from its middle

class Section : public ::testing::Test {
 protected:
  void SetUp() override {
    context_ = EglContext::create().value();
    renderer_.emplace(Renderer::create().value());
    shading_ = shading_preset("phong").value();
    shading_.style.section = true;
    shading_.background.color = {0, 0, 0};
    view_.clip_from_view = glm::ortho(-kHalf, kHalf, -kHalf, kHalf, -100.0, 100.0);
  }
  Image picture(const SceneView& scene) {
    auto array = ViewArray::create(kSectionSide, kSectionSide, 1).value();
    const auto drawn = renderer_->render(scene, std::span(&view_, 1), 1, array);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return array.read_layer(0).value();
  }
  /// Burnt clay, which light never makes of this style: red at least twice blue, and dark.
  static bool filled(const std::uint8_t* p) { return p[0] > 60 && p[0] < 165 && 10 * p[2] < 8 * p[0]; }
  static double filled_mm2(const Image& image) {
    int count = 0;
    for (int y = 0; y < kSectionSide; ++y)
      for (int x = 0; x < kSectionSide; ++x) count += filled(image.at(x, y)) ? 1 : 0;
    return count * std::pow(2 * kHalf / kSectionSide, 2);
  }
  std::unique_ptr<EglContext> context_;
  std::optional<Renderer> renderer_;
  Shading shading_;
  View view_;
};

/// A ball of 10 mm, and one of 6 mm in it that is turned inside out: a shell.
TriMesh shell() {
  TriMesh mesh = testing::sphere(10.0f, 120, 240);
  TriMesh hole = testing::sphere(6.0f, 120, 240);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::size_t v = 0; v < hole.positions.size(); ++v) {
    mesh.positions.push_back(hole.positions[v]);
    mesh.normals.push_back(-hole.normals[v]);
  }
  for (const Triangle& t : hole.triangles) mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  return mesh;
}

TEST_F(Section, OfABallIsTheDiskWhereThePlaneMeetsIt) {
  const LodMesh ball = LodMesh::exact(pack_mesh(testing::sphere(10.0f, 160, 320)).value()).value();
  for (const double height : {0.0, 4.0, -6.0}) {
    shading_.clips = {{{0, 0, height}, {0, 0, -1}}};
    const double disk = std::numbers::pi * (100 - height * height);
    EXPECT_NEAR(filled_mm2(picture(MeshScene(ball, shading_))), disk, 0.02 * disk) << height;
  }
  shading_.style.section = false;
  EXPECT_LT(filled_mm2(picture(MeshScene(ball, shading_))), 1.0) << "only where it is asked for";
  shading_.style.section = true;
  shading_.clips.clear();
  EXPECT_LT(filled_mm2(picture(MeshScene(ball, shading_))), 1.0) << "nothing is cut";
}

TEST_F(Section, OfAShellIsARing) {
  const LodMesh mesh = LodMesh::exact(pack_mesh(shell()).value()).value();
  shading_.clips = {{{0, 0, 0}, {0, 0, -1}}};
  const double ring = std::numbers::pi * (100 - 36);
  const Image image = picture(MeshScene(mesh, shading_));
  EXPECT_NEAR(filled_mm2(image), ring, 0.03 * ring);
  EXPECT_FALSE(filled(image.at(kSectionSide / 2, kSectionSide / 2))) << "into the hollow one looks";
}

TEST_F(Section, BetweenTwoPlanesIsSeenWhereTheEyeComesIn) {
  const LodMesh ball = LodMesh::exact(pack_mesh(testing::sphere(10.0f, 160, 320)).value()).value();
  shading_.clips = {{{0, 0, 3}, {0, 0, -1}}, {{1, 0, 0}, {-1, 0, 0}}, {{0, 0, -3}, {0, 0, 1}}};
  const Image image = picture(MeshScene(ball, shading_));
  // The disk of the front plane, as far as x = 1: a circular segment of radius sqrt(91).
  const double r = std::sqrt(91.0), area = std::numbers::pi * r * r - (r * r * std::acos(1 / r) - std::sqrt(r * r - 1));
  EXPECT_NEAR(filled_mm2(image), area, 0.03 * area);
  EXPECT_EQ(image.at(kSectionSide / 2 + 40, kSectionSide / 2)[0], 0) << "beyond the second plane there is nothing";
}

/// Two bodies that touch in the plane z = 0: a ball of 8 mm cut in half, the front one partition 0, the back one 1. The
/// disk between them is of both, once for each, and the scan does not show it.
TriMesh two_halves(bool back_first, int rings = 24) {
  TriMesh mesh;
  const int segments = 4 * rings;
  const auto half = [&](double side, std::uint8_t partition) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto add = [&](double radius, double height, const glm::dvec3& normal, int s) {
      const double phi = 2 * std::numbers::pi * s / segments;
      mesh.positions.emplace_back(glm::dvec3(radius * std::cos(phi), radius * std::sin(phi), height));
      mesh.normals.emplace_back(normal);
      if (normal == glm::dvec3(0.0)) mesh.normals.back() = glm::normalize(mesh.positions.back());
    };
    for (int r = 0; r <= rings; ++r)
      for (int s = 0; s < segments; ++s) {
        const double theta = 0.5 * std::numbers::pi * r / rings;
        add(8 * std::sin(theta), side * 8 * std::cos(theta), glm::dvec3(0.0), s);
      }
    const auto disk = static_cast<std::uint32_t>(mesh.positions.size());
    for (int r = 0; r <= rings; ++r)
      for (int s = 0; s < segments; ++s) add(8.0 * r / rings, 0.0, {0, 0, -side}, s);
    const auto strip = [&](std::uint32_t from, bool turned, bool inferred) {
      for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s) {
          const auto id = [&](int ring, int place) {
            return from + static_cast<std::uint32_t>(ring * segments + place % segments);
          };
          for (Triangle t : {Triangle{id(r, s), id(r + 1, s), id(r + 1, s + 1)},
                             Triangle{id(r, s), id(r + 1, s + 1), id(r, s + 1)}}) {
            if (turned) std::swap(t[1], t[2]);
            mesh.triangles.push_back(t);
            mesh.triangle_partition.push_back(partition);
            mesh.triangle_inferred.push_back(inferred ? 1 : 0);
          }
        }
    };
    strip(first, side < 0, false);
    strip(disk, side > 0, true);
  };
  half(1.0, back_first ? 1 : 0);
  half(-1.0, back_first ? 0 : 1);
  return mesh;
}

// What stands behind the plane is massive: the border between the bodies is no surface that anybody could see.
TEST_F(Section, WhereTwoBodiesTouchIsFilledAndNotTheirBorder) {
  const double r2 = 64.0 - 9.0, disk = std::numbers::pi * r2;
  for (const bool back_first : {false, true})
    for (const double tilt : {0.0, 0.3, -0.7}) {
      const LodMesh mesh = LodMesh::exact(pack_mesh(two_halves(back_first)).value()).value();
      shading_.clips = {{{0, 0, 3}, {0, 0, -1}}};
      view_.view_from_world = glm::rotate(glm::dmat4(1.0), tilt, glm::dvec3(0.3, 1, 0));
      const Image image = picture(MeshScene(mesh, shading_));
      EXPECT_NEAR(filled_mm2(image), disk * std::cos(tilt), 0.02 * disk) << back_first << " " << tilt;
      int blue = 0;
      for (int y = 0; y < kSectionSide; ++y)
        for (int x = 0; x < kSectionSide; ++x) blue += image.at(x, y)[2] > image.at(x, y)[0] + 20 ? 1 : 0;
      EXPECT_EQ(blue, 0) << "no patch is seen, " << back_first << " " << tilt;
    }
}

// Levels of detail move the vertices of both by up to their cells.
TEST_F(Section, WhereTwoBodiesTouchIsFilledInCoarseLevelsToo) {
  PackedMesh packed = pack_mesh(two_halves(false, 120)).value();
  LodMesh mesh = LodMesh::growing(packed).value();
  while (!mesh.complete()) ASSERT_TRUE(mesh.update());
  ASSERT_GT(mesh.levels(), 1);
  shading_.clips = {{{0, 0, 3}, {0, 0, -1}}};
  auto array = ViewArray::create(kSectionSide, kSectionSide, 1).value();
  const int layer = 0;
  ASSERT_TRUE(
      renderer_->render_layers(MeshScene(mesh, shading_), std::span(&view_, 1), std::span(&layer, 1), array, 12));
  EXPECT_NEAR(filled_mm2(array.read_layer(0).value()), std::numbers::pi * 55, 5.0);
}

}  // namespace
}  // namespace dubsar
