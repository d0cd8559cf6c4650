// Warm light where a hand would take hold: on the surface, in its depth.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr int kSize = 200;

class GlowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    context_ = EglContext::create().value();
    renderer_ = Renderer::create().value();
    // A near plate on the left, one 20 mm behind it on the right.
    TriMesh mesh;
    testing::add_rectangle(mesh, {-20, -20, 0}, {20, 0, 0}, {0, 40, 0}, 0);
    testing::add_rectangle(mesh, {0, -20, -20}, {20, 0, 0}, {0, 40, 0}, 1);
    mesh_ = LodMesh::exact(pack_mesh(mesh).value()).value();
  }
  static View seen_from(double x) {  // 300 mm before the plane z = 0, which is 50 mm wide
    View view;
    view.view_from_world = glm::translate(glm::dmat4(1.0), glm::dvec3(-x, 0, -300));
    const double near = 200, scale = near / 300;
    view.clip_from_view = glm::frustum((-25 - x) * scale, (25 - x) * scale, -25 * scale, 25 * scale, near, 400.0);
    return view;
  }
  Image picture(const View& view, const Glow& glow) {
    const MeshScene whole(*mesh_, shading_preset("phong").value());
    SceneView scene = whole;
    scene.glow = glow;
    auto array = ViewArray::create(kSize, kSize, 1).value();
    const auto done = renderer_->render(scene, std::span(&view, 1), 1, array);
    EXPECT_TRUE(done) << done.error().message;
    return array.read_layer(0).value();
  }
  /// Middle of what is brighter in `with`, in pixels; how many pixels that are.
  struct Spot {
    double x = 0.0, y = 0.0, weight = 0.0;
    int count = 0;
  };
  static Spot brighter(const Image& without, const Image& with) {
    Spot out;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double more = with.at(x, y)[0] - without.at(x, y)[0];
        EXPECT_GE(more, 0.0);
        if (more <= 0) continue;
        ++out.count;
        out.x += more * (x + 0.5);
        out.y += more * (y + 0.5);
        out.weight += more;
      }
    out.x /= std::max(out.weight, 1e-9);
    out.y /= std::max(out.weight, 1e-9);
    return out;
  }
  std::unique_ptr<GlContext> context_;
  std::optional<LodMesh> mesh_;
  std::optional<Renderer> renderer_;
};

TEST_F(GlowTest, LiesOnTheSurfaceWhereItIsAndNowhereElse) {
  const View view = seen_from(0.0);
  const Image without = picture(view, {});
  const Image with = picture(view, {{-10, 5, 40}, 6.0, 0.8});
  const Spot spot = brighter(without, with);
  EXPECT_NEAR(spot.x, (25.0 - 10.0) / 50.0 * kSize, 1.0);
  EXPECT_NEAR(spot.y, (25.0 - 5.0) / 50.0 * kSize, 1.0);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double from = std::hypot(x + 0.5 - 60.0, y + 0.5 - 80.0) / kSize * 50.0;
      if (from > 6.2) {
        EXPECT_EQ(with.at(x, y)[0], without.at(x, y)[0]) << x << ' ' << y;
      }
    }
  const std::uint8_t* const middle = with.at(60, 80);
  EXPECT_GT(middle[0] - without.at(60, 80)[0], middle[2] - without.at(60, 80)[2] + 10) << "warm";
}

TEST_F(GlowTest, EachEyeSeesItAtTheDepthOfTheSurfaceItLiesOn) {
  const Glow far{{10, 0, 0}, 5.0, 0.8};  // on the plate 20 mm behind
  std::array<double, 2> at{};
  for (int eye = 0; eye < 2; ++eye) {
    const double x = eye == 0 ? -32.5 : 32.5;
    const Spot spot = brighter(picture(seen_from(x), {}), picture(seen_from(x), far));
    at[static_cast<std::size_t>(eye)] = spot.x;
    // The line of sight to (10, 0, -20) meets the plane z = 0 here.
    const double meets = x + (10.0 - x) * 300.0 / 320.0;
    EXPECT_NEAR(spot.x, (25.0 + meets) / 50.0 * kSize, 1.5) << "eye " << eye;
  }
  EXPECT_GT(at[1] - at[0], 12.0) << "uncrossed: behind the panel";
}

TEST_F(GlowTest, NothingWithoutStrengthAndNoNonsense) {
  const View view = seen_from(0.0);
  EXPECT_EQ(picture(view, {}).pixels, picture(view, {{0, 0, 0}, 10.0, 0.0}).pixels);
  const MeshScene whole(*mesh_, shading_preset("phong").value());
  SceneView scene = whole;
  scene.glow = {{0, 0, 0}, 0.0, 0.5};
  EXPECT_EQ(check_scene(scene).error().kind, ErrorKind::kUsage);
  scene.glow = {{0, 0, 0}, 5.0, 1.5};
  EXPECT_EQ(check_scene(scene).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
