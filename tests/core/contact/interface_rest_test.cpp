#include "core/contact/interface_rest.h"

#include <gtest/gtest.h>

#include "core/mesh/intersections.h"
#include "core/mesh/mesh_check.h"
#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

constexpr int kRestEdge = 41;

/// A plateau over a flat rim, with steps like those of a cut through a grid.
glm::vec3 plateau(int x, int y) {
  const int inward = std::min({x, y, kRestEdge - 1 - x, kRestEdge - 1 - y});
  const float stairs = inward > 5 && (x / 2 + y / 3) % 2 == 0 ? 0.5f : 0.0f;
  return {static_cast<float>(x), static_cast<float>(y), 2.0f * static_cast<float>(std::min(inward, 5)) + stairs};
}

/// A hole in the shape of an L, whose middle is not in it.
bool in_hole(int x, int y) { return x >= 12 && x < 30 && y >= 12 && y < 30 && (x < 16 || y < 16); }

TEST(CloseRest, AWideLoopIsClosedWithoutCrossingTheSheetAroundIt) {
  InterfaceMesh mesh = sheet(kRestEdge, plateau, [](int x, int y) { return !in_hole(x, y); });
  const SurfaceModel model;
  SilentProgress progress;
  const Result<std::int64_t> loops = close_rest(model, FaceGraph{}, mesh, progress);
  ASSERT_TRUE(loops);
  EXPECT_EQ(*loops, 2) << "the hole and the rim of the sheet";
  EXPECT_EQ(mesh.strength.size(), mesh.added.size());
  EXPECT_TRUE(check_mesh(mesh.added, mesh.triangles).watertight());
  EXPECT_EQ(self_intersections(mesh.added, mesh.triangles).size(), 0u);
}

TEST(CloseRest, ATinyLoopIsAStar) {
  InterfaceMesh mesh = sheet(kRestEdge, plateau, [](int x, int y) { return x != 14 || y != 14; });
  const std::size_t before = mesh.triangles.size();
  SilentProgress progress;
  ASSERT_EQ(close_rest(SurfaceModel(), FaceGraph{}, mesh, progress).value(), 2);
  const auto around = [&](const glm::vec3& corner) {
    int count = 0;
    for (std::size_t t = before; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t]) count += mesh.added[v] == corner;
    return count;
  };
  const glm::vec3 middle = 0.25f * (plateau(14, 14) + plateau(15, 14) + plateau(15, 15) + plateau(14, 15));
  EXPECT_EQ(around(middle), 4);
}

}  // namespace
}  // namespace dubsar
