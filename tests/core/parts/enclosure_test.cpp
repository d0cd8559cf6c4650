#include "core/parts/enclosure.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/system/parallel.h"
#include "tests/core/parts/grid_scene.h"

namespace dubsar {
namespace {

TEST(Enclosure, ABallCutByAPlaneHasTheVolumesOfItsCaps) {
  const float radius = 20.0f;
  SurfaceModel model = scene::extract_model({50, 50, 50}, [&](const glm::vec3& p) {
    return scene::ball(p, {24.6f, 24.3f, 24.4f}, radius);
  });
  const float cut = 24.6f + 9.0f;
  for (const auto& q : model.mesh.quads) {
    float x = 0.0f;
    for (const std::uint32_t v : q) x += 0.25f * model.mesh.positions[v].x;
    model.quad_partition.push_back(x > cut);
  }
  model.partitions = {{.id = 0, .name = "most", .body = ""}, {.id = 1, .name = "cap", .body = ""}};
  SilentProgress progress;
  const FaceGraph graph = FaceGraph::build(model.mesh, progress).value();
  const std::vector<double> volume = enclosed_volumes(model, graph);
  ASSERT_EQ(volume.size(), 2u);
  const double pi = std::numbers::pi, r = 20.0, h = 11.0;
  const double cap = pi * h * h * (3.0 * r - h) / 3.0, ball = 4.0 / 3.0 * pi * r * r * r;
  EXPECT_NEAR(volume[1], cap, 0.01 * cap);
  EXPECT_NEAR(volume[0], ball - cap, 0.01 * (ball - cap));
  for (const int threads : {1, 7}) {
    set_thread_count(threads);
    EXPECT_EQ(enclosed_volumes(model, graph), volume);
  }
  set_thread_count(0);
  // What closes one side opens the other: the sum does not know where the cut was.
  model.quad_partition.assign(model.mesh.quads.size(), 0);
  EXPECT_NEAR(enclosed_volumes(model, graph)[0], volume[0] + volume[1], 1e-4 * ball);
}

TEST(Enclosure, ATabletFillsAtLeastHalfOfItsCavityAndNoMoreThanAllOfIt) {
  EXPECT_TRUE(plausible_enclosure(84.0, 100.0, 200.0));
  EXPECT_FALSE(plausible_enclosure(39.0, 100.0, 200.0)) << "a brain in its skull";
  EXPECT_FALSE(plausible_enclosure(-84.0, 100.0, 200.0)) << "walls that enclose nothing";
  EXPECT_FALSE(plausible_enclosure(84.0, -100.0, 200.0));
  EXPECT_FALSE(plausible_enclosure(101.0, 100.0, 200.0));
  EXPECT_FALSE(plausible_enclosure(84.0, 100.0, 99.0));
}

/// Figures of closed parts, in mm2 and mm3.
PartitionTable measured(double area, double tablet, double cavity, double outside) {
  return {{.id = 0, .name = "tablet", .area_mm2 = area, .volume_mm3 = tablet},
          {.id = 1, .name = "envelope outside", .body = "envelope", .volume_mm3 = outside},
          {.id = 2, .name = "envelope inside", .body = "envelope", .volume_mm3 = -cavity}};
}

TEST(Enclosure, ATabletIsALump) {
  EXPECT_TRUE(plausible_enclosure(measured(7100, 27300, 31500, 57900))) << "a phantom of a tablet";
  EXPECT_TRUE(plausible_enclosure(measured(2 * 64 + 32, 64, 80, 200))) << "a plate of 8 x 8 x 1";
  EXPECT_TRUE(plausible_enclosure(measured(1.3 * 7100, 27300, 31500, 57900))) << "rough with noise";
  EXPECT_FALSE(plausible_enclosure(measured(23140, 62330, 66760, 312100))) << "a brain with its furrows";
  EXPECT_FALSE(plausible_enclosure(measured(30661, 55307, 60000, 892000))) << "a felt";
  EXPECT_FALSE(plausible_enclosure(measured(7100, 27300, 90000, 157900))) << "it rattles";
  EXPECT_TRUE(plausible_enclosure(PartitionTable{{.id = 0, .name = "object", .area_mm2 = 9, .volume_mm3 = 0.1}}));
}

}  // namespace
}  // namespace dubsar
