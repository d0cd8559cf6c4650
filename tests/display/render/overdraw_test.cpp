// What is drawn for nothing: fragments behind others, faces that cast no shadow of their own.

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <set>

#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/passes/shadow_map.h"
#include "display/render/renderer.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr int kOverdrawSide = 240;  // pixels; 4 a mm
constexpr double kFinest = 1e-3;    // pixels that may be merged: quick, but with all triangles

class Overdraw : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
    view_.clip_from_view = glm::ortho(-30.0, 30.0, -30.0, 30.0, -100.0, 100.0);
  }
  static LodMesh chunked(const TriMesh& mesh) {
    PackedMesh packed = pack_mesh(mesh).value();
    sort_into_chunks(packed);
    return LodMesh::exact(packed).value();
  }
  /// Fragments that were nearest so far, for a pixel that is not background.
  double fragments_a_pixel(const LodMesh& mesh, const glm::dmat4& world) {
    auto renderer = Renderer::create().value();
    auto array = ViewArray::create(kOverdrawSide, kOverdrawSide, 1).value();
    Shading shading = shading_preset("phong").value();
    shading.background = {{0, 0, 255}, false};
    const MeshScene scene(mesh, shading, world);
    const int layer = 0;
    GLuint query = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    EXPECT_TRUE(renderer.render_layers(scene, std::span(&view_, 1), std::span(&layer, 1), array, kFinest));
    glEndQuery(GL_SAMPLES_PASSED);
    GLuint64 fragments = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &fragments);
    glDeleteQueries(1, &query);
    const Image image = array.read_layer(0).value();
    int covered = 0;
    for (int y = 0; y < kOverdrawSide; ++y)
      for (int x = 0; x < kOverdrawSide; ++x) covered += image.at(x, y)[2] < 255;
    EXPECT_GT(covered, kOverdrawSide * kOverdrawSide / 4);
    return static_cast<double>(fragments) / covered;
  }

  std::unique_ptr<EglContext> context_;
  View view_;
};

TEST_F(Overdraw, WhatIsNearerComesFirstAndNothingIsLost) {
  const LodMesh ball = chunked(testing::sphere(25, 100, 200));
  for (const double turn : {0.0, 90.0, 180.0, 270.0}) {
    View view = view_;
    view.view_from_world = glm::rotate(glm::dmat4(1.0), glm::radians(turn), glm::dvec3(1, 0, 0));
    std::int64_t count = 0;
    std::set<std::int64_t> firsts;
    for (const auto& [first, triangles] : ball.level(0).visible_ranges(0xff, std::span(&view, 1))) {
      EXPECT_TRUE(firsts.insert(first).second);
      count += triangles;
    }
    EXPECT_EQ(count, ball.triangles(0)) << turn;
  }
  for (const double turn : {0.0, 60.0, 120.0, 180.0, 240.0, 300.0}) {
    const glm::dmat4 world = glm::rotate(glm::dmat4(1.0), glm::radians(turn), glm::normalize(glm::dvec3(1, 0.3, 0)));
    EXPECT_LT(fragments_a_pixel(ball, world), 1.45) << turn;
  }
}

TEST_F(Overdraw, AnEnvelopeComesBeforeItsTablet) {
  TriMesh both = testing::sphere(20, 100, 200);
  const std::size_t inner = both.triangles.size();
  const TriMesh outer = testing::sphere(25, 100, 200);
  const auto begin = static_cast<std::uint32_t>(both.positions.size());
  both.positions.insert(both.positions.end(), outer.positions.begin(), outer.positions.end());
  both.normals.clear();
  for (const Triangle& t : outer.triangles) both.triangles.push_back({t[0] + begin, t[1] + begin, t[2] + begin});
  for (std::size_t t = 0; t < both.triangles.size(); ++t) both.triangle_partition.push_back(t < inner ? 0 : 1);
  both.partitions = {{.id = 0, .name = "tablet"}, {.id = 1, .name = "envelope"}};
  EXPECT_LT(fragments_a_pixel(chunked(both), glm::dmat4(1.0)), 1.45);
}

TEST_F(Overdraw, FacesThatTurnAwayFromTheLightCastNothingOnlyWhileThingsMoveAndNothingIsCut) {
  auto map = ShadowMap::create().value();
  TriMesh sheet;  // its front is down
  testing::add_rectangle(sheet, {-20, -20, 0}, {0, 40, 0}, {40, 0, 0}, 0);
  const LodMesh mesh = chunked(sheet);
  Shading shading = shading_preset("raking").value();
  shading.light.elevation_deg = 60;
  const auto casts = [&](double coarse_px, bool cut, const glm::dmat4& world) {
    if (cut) shading.clips = {{{0, 0, -15}, {0, 0, 1}}};
    const MeshScene scene(mesh, shading, world);
    shading.clips.clear();
    EXPECT_TRUE(map.draw(scene, std::span(&view_, 1), 64, coarse_px, kOverdrawSide));
    std::vector<float> depths(64 * 64);
    glGetTextureImage(map.texture(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                      static_cast<GLsizei>(depths.size() * sizeof(float)), depths.data());
    return std::any_of(depths.begin(), depths.end(), [](float depth) { return depth < 1.0f; });
  };
  const glm::dmat4 as_it_is(1.0), turned = glm::rotate(glm::dmat4(1.0), glm::radians(180.0), glm::dvec3(1, 0, 0)),
                                  mirrored = glm::scale(glm::dmat4(1.0), glm::dvec3(1, -1, 1)),
                                  upside = glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1));
  EXPECT_FALSE(casts(1.5, false, as_it_is));
  EXPECT_TRUE(casts(1.5, true, as_it_is));
  EXPECT_TRUE(casts(0.0, false, as_it_is)) << "the exact map";
  EXPECT_TRUE(casts(1.5, false, turned));
  EXPECT_FALSE(casts(1.5, false, mirrored));
  EXPECT_TRUE(casts(1.5, false, upside)) << "this mirror turns its front up";
}

}  // namespace
}  // namespace dubsar
