// Pictures that are larger than what is drawn at once: no seam where two pieces meet.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "display/render/context/context_egl.h"
#include "display/render/images/render_image.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"
#include "display/render/view_array.h"

namespace dubsar {
namespace {

constexpr int kWide = 10000, kHigh = 300;

/// A strip of 200 x 6 mm with waves, a wall that casts shadows, and a band across it that the scan does not show.
TriMesh strip() {
  TriMesh mesh;
  constexpr int kAcross = 1200, kUp = 36;
  for (int y = 0; y <= kUp; ++y)
    for (int x = 0; x <= kAcross; ++x) {
      const double px = 200.0 * x / kAcross, py = 6.0 * y / kUp;
      const double wall = std::exp(-8.0 * (py - 3.0) * (py - 3.0));
      mesh.positions.push_back(glm::vec3(px, py, 0.3 * std::sin(1.3 * px) * std::cos(2.0 * py) + 0.8 * wall));
    }
  for (std::uint32_t y = 0; y < kUp; ++y)
    for (std::uint32_t x = 0; x < kAcross; ++x) {
      const std::uint32_t a = y * (kAcross + 1) + x, b = a + 1, c = a + kAcross + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
      for (int k = 0; k < 2; ++k) mesh.triangle_inferred.push_back(x % 200 > 150 ? 1 : 0);
    }
  mesh.frame.input_voxel.provenance = "made";
  return mesh;
}

/// Mean difference between a column and the one before it, grey levels.
double step_at(const Image& image, int x) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) sum += std::abs(image.at(x, y)[1] - image.at(x - 1, y)[1]);
  return sum / image.height;
}

class WidePicture : public ::testing::TestWithParam<const char*> {};

TEST_P(WidePicture, OfTenThousandPixelsIsThatOfOnePieceWithoutSeams) {
  const TriMesh mesh = strip();
  RenderOptions options;
  options.shading = shading_preset(GetParam()).value();
  options.samples = 1;
  options.camera.object = ObjectFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  options.camera.margin = 0.0;
  options.camera.mm_per_pixel = 200.0 / kWide;
  options.camera.width = kWide;
  options.camera.height = kHigh;
  SilentProgress progress;
  const auto tiled = render_picture(mesh, options, progress);
  ASSERT_TRUE(tiled) << tiled.error().message;
  ASSERT_EQ(tiled->image.width, kWide);

  const auto context = EglContext::create();
  ASSERT_TRUE(context);
  const auto packed = pack_mesh(mesh);
  ASSERT_TRUE(packed);
  const auto gpu = LodMesh::exact(*packed);
  auto renderer = Renderer::create();
  auto whole = ViewArray::create(kWide, kHigh, 1);
  ASSERT_TRUE(gpu && renderer && whole);
  const auto camera = fit_camera(packed->box_of(0xff), options.camera);
  ASSERT_TRUE(camera);
  const MeshScene scene(*gpu, options.shading);
  ASSERT_TRUE(renderer->render(scene, std::span(&camera->view, 1), 1, *whole));
  const Image expected = whole->read_layer(0).value();

  int differ = 0, at_seams = 0, lit = 0;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      int most = 0;
      for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(tiled->image.at(x, y)[c] - expected.at(x, y)[c]));
      lit += expected.at(x, y)[0] > 60 ? 1 : 0;
      if (most <= 3) continue;
      ++differ;
      if (std::abs(x - 4096) <= 2 || std::abs(x - 8192) <= 2) ++at_seams;
    }
  EXPECT_GT(lit, kWide * kHigh / 4);
  for (const int seam : {4096, 8192}) {
    double around = 0.0;
    for (int x = seam - 20; x <= seam + 20; ++x) around = std::max(around, x == seam ? 0.0 : step_at(tiled->image, x));
    EXPECT_LE(step_at(tiled->image, seam), around + 0.2) << "between columns " << seam - 1 << " and " << seam;
  }
  if (options.shading.light.shadows) return;  // their map is finer for a piece than for the whole
  EXPECT_LT(differ, kWide * kHigh / 2000) << "rounding moves some borders by a pixel";
  EXPECT_LT(at_seams, 10) << "of " << 10 * kHigh << " pixels where pieces meet";
}

INSTANTIATE_TEST_SUITE_P(Styles, WidePicture, ::testing::Values("phong", "raking"));

}  // namespace
}  // namespace dubsar
