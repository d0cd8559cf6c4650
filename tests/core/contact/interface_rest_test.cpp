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

TEST(PartFans, TwoBodiesThatTouchAtAVertexComeApartAndAreClosed) {
  const std::vector<Triangle> tetrahedron{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  constexpr std::uint32_t kFirst = 100;  // vertices of a surface that nothing here uses
  InterfaceMesh mesh;
  mesh.added = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {-4, 0, 0}, {0, -4, 0}, {0, 0, -4}};
  mesh.strength.assign(mesh.added.size(), 1.0f);
  for (const std::array<std::uint32_t, 4>& of : {std::array<std::uint32_t, 4>{0, 1, 2, 3}, {0, 5, 4, 6}})
    for (const Triangle& t : tetrahedron)
      mesh.triangles.push_back({kFirst + of[t[0]], kFirst + of[t[1]], kFirst + of[t[2]]});
  part_fans(kFirst, mesh);
  ASSERT_EQ(mesh.added.size(), 8u);
  EXPECT_EQ(mesh.strength.size(), 8u);
  EXPECT_EQ(mesh.added[0], glm::vec3(0.0f));
  EXPECT_GT(glm::distance(mesh.added[7], mesh.added[0]), 0.1f);
  EXPECT_LT(glm::distance(mesh.added[7], mesh.added[0]), 1.5f);
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles)
    for (std::uint32_t& v : t) v -= kFirst;
  const MeshCheck check = check_mesh(mesh.added, triangles);
  EXPECT_TRUE(check.watertight());
  EXPECT_EQ(check.nonmanifold_vertices, 0);
  EXPECT_EQ(self_intersections(mesh.added, triangles).size(), 0u);
  part_fans(kFirst, mesh);
  EXPECT_EQ(mesh.added.size(), 8u) << "nothing is left to do";
}

}  // namespace
}  // namespace dubsar
