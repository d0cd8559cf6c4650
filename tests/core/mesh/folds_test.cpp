#include "core/mesh/folds.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

/// A tetrahedron, and a fold of corners of its own upon one of its faces' edges.
TriMesh folded() {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {2, 2, 2}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {4, 5, 6}, {1, 2, 3}, {0, 3, 2}, {1, 0, 6}};
  mesh.triangle_partition = {0, 0, 0, 1, 0, 0};
  mesh.triangle_inferred = {0, 0, 1, 0, 1, 1};
  return mesh;
}

TEST(Folds, BothTrianglesGoAndTheFieldsOfOthersStayWithThem) {
  TriMesh mesh = folded();
  EXPECT_EQ(remove_folds(mesh), 2);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
  EXPECT_EQ(mesh.triangle_partition, (std::vector<PartitionId>{0, 0, 1, 0}));
  EXPECT_EQ(mesh.triangle_inferred, (std::vector<std::uint8_t>{0, 0, 0, 1}));
  EXPECT_EQ(remove_folds(mesh), 0);
}

TEST(Folds, TrianglesWithTwoCornersAtOnePlaceGo) {
  TriMesh mesh = folded();
  mesh.triangles[2] = {0, 4, 6};
  EXPECT_EQ(remove_folds(mesh), 1);
  EXPECT_EQ(mesh.triangles.size(), 5U);
  EXPECT_EQ(mesh.triangles[2], (Triangle{1, 2, 3}));
}

TEST(Folds, PatchesOfTwoPartsOnEachOtherStay) {
  TriMesh mesh = folded();
  mesh.triangle_partition[2] = 1;
  EXPECT_EQ(remove_folds(mesh), 0);
  EXPECT_EQ(mesh.triangles.size(), 6U);
}

TEST(Folds, TwiceTheSameTriangleIsNoFold) {
  TriMesh mesh = folded();
  mesh.triangles[5] = {0, 1, 6};
  EXPECT_EQ(remove_folds(mesh), 0);
}

}  // namespace
}  // namespace dubsar
