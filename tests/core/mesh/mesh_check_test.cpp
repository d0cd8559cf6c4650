#include "core/mesh/mesh_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

const std::vector<glm::vec3> kPoints = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                                        {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {2, 2, 2}};
const std::vector<Triangle> kTetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

std::vector<Triangle> with(std::vector<Triangle> triangles, const std::vector<Triangle>& more) {
  triangles.insert(triangles.end(), more.begin(), more.end());
  return triangles;
}

TEST(MeshCheck, TetrahedronIsWatertight) {
  const MeshCheck c = check_mesh(kPoints, kTetrahedron);
  EXPECT_TRUE(c.watertight());
  EXPECT_EQ(c.vertices, 4);
  EXPECT_EQ(c.edges, 6);
  EXPECT_EQ(c.euler, 2);
  EXPECT_EQ(c.components, 1);
}

TEST(MeshCheck, TwoTetrahedraAtOneVertexShareANonManifoldVertex) {
  const MeshCheck c = check_mesh(kPoints, with(kTetrahedron, {{0, 5, 4}, {0, 4, 6}, {4, 5, 6}, {5, 0, 6}}));
  EXPECT_EQ(c.nonmanifold_vertices, 1);
  EXPECT_EQ(c.nonmanifold_edges, 0);
  EXPECT_EQ(c.boundary_edges, 0);
  EXPECT_EQ(c.components, 1);
  EXPECT_FALSE(c.manifold());
}

TEST(MeshCheck, ThreeTrianglesAtAnEdgeAreNonManifold) {
  const MeshCheck c = check_mesh(kPoints, std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(c.nonmanifold_edges, 1);
  EXPECT_EQ(c.nonmanifold_vertices, 2);
  EXPECT_EQ(c.boundary_edges, 6);
}

TEST(MeshCheck, AFlippedTriangleHasThreeInconsistentEdges) {
  auto flipped = kTetrahedron;
  std::swap(flipped[0][0], flipped[0][1]);
  const MeshCheck c = check_mesh(kPoints, flipped);
  EXPECT_EQ(c.inconsistent_edges, 3);
  EXPECT_EQ(c.nonmanifold_vertices, 0);
  EXPECT_FALSE(c.watertight());
}

TEST(MeshCheck, OpenFanIsManifoldWithABoundary) {
  const MeshCheck c = check_mesh(kPoints, std::vector<Triangle>{{0, 1, 2}, {0, 2, 4}, {0, 4, 5}});
  EXPECT_TRUE(c.manifold());
  EXPECT_FALSE(c.watertight());
  EXPECT_EQ(c.boundary_edges, 5);
  EXPECT_EQ(c.euler, 1);
}

TEST(MeshCheck, TwoFansOfOneVertexAreABowTie) {
  const MeshCheck c = check_mesh(kPoints, std::vector<Triangle>{{0, 1, 2}, {0, 4, 5}});
  EXPECT_EQ(c.nonmanifold_vertices, 1);
}

TEST(MeshCheck, DegenerateAndFlatTrianglesAreToldApart) {
  const std::vector<glm::vec3> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, NAN, 0}};
  const MeshCheck c = check_mesh(points, std::vector<Triangle>{{0, 1, 2}, {0, 0, 1}, {0, 1, 3}});
  EXPECT_EQ(c.degenerate_triangles, 1);
  EXPECT_EQ(c.zero_area_triangles, 2);
}

TEST(MeshCheck, TheSameTriangleTwiceIsAClosedPillowOnlyWhenReversed) {
  EXPECT_TRUE(check_mesh(kPoints, std::vector<Triangle>{{0, 1, 2}, {0, 2, 1}}).watertight());
  EXPECT_EQ(check_mesh(kPoints, std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}).inconsistent_edges, 3);
}

TEST(MeshCheck, TorusHasEulerNumberZero) {
  constexpr std::uint32_t n = 40, m = 30;
  std::vector<glm::vec3> points;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < m; ++j) {
      const float a = 6.2831853f * static_cast<float>(i) / n, b = 6.2831853f * static_cast<float>(j) / m;
      points.push_back({(3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b)});
      const auto id = [&](std::uint32_t k, std::uint32_t l) { return k % n * m + l % m; };
      triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  const MeshCheck c = check_mesh(points, triangles);
  EXPECT_TRUE(c.watertight());
  EXPECT_EQ(c.euler, 0);
  EXPECT_EQ(c.edges, 3 * n * m);
  EXPECT_EQ(check_mesh(points, {}).euler, 0);
  EXPECT_FALSE(check_mesh(points, {}).watertight());
}

TEST(MeshCheck, AFanOfManyTrianglesIsCheckedInLinearTime) {
  constexpr std::uint32_t n = 300000;
  std::vector<glm::vec3> points(n + 1);
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < n; ++i) {
    points[i + 1] = {std::cos(static_cast<float>(i)), std::sin(static_cast<float>(i)), 1.0f};
    triangles.push_back({0, i + 1, (i + 1) % n + 1});
  }
  const MeshCheck c = check_mesh(points, triangles);
  EXPECT_TRUE(c.manifold());
  EXPECT_EQ(c.boundary_edges, n);
  EXPECT_EQ(c.euler, 1);
}

TEST(MeshCheck, ThreadsDoNotChangeWhatIsFoundInALargeMesh) {
  // A plate of many vertices with faults all over it: a hole, a triangle turned over, one that is there twice.
  constexpr std::uint32_t kSide = 700;
  std::vector<glm::vec3> points;
  std::vector<Triangle> triangles;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      points.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
      if (x + 1 == kSide || y + 1 == kSide) continue;
      const std::uint32_t v = y * kSide + x;
      if ((x * 31 + y * 17) % 1009 != 0) triangles.push_back({v, v + 1, v + kSide + 1});
      triangles.push_back({v, v + kSide + 1, v + kSide});
      if ((x * 13 + y * 29) % 2003 == 0) std::swap(triangles.back()[0], triangles.back()[1]);
      if ((x * 7 + y * 3) % 3001 == 0) triangles.push_back(triangles.back());
    }
  std::vector<PartitionId> parts(triangles.size());
  for (std::size_t t = 0; t < parts.size(); ++t) parts[t] = static_cast<PartitionId>(t % 3);
  std::vector<MeshCheck> found;
  std::vector<std::vector<bool>> tight;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    found.push_back(check_mesh(points, triangles));
    tight.push_back(watertight_parts(points.size(), triangles, parts));
  }
  set_thread_count(0);
  EXPECT_GT(found[0].nonmanifold_edges, 100);
  EXPECT_GT(found[0].inconsistent_edges, 100);
  for (const MeshCheck& c : found) {
    EXPECT_EQ(c.edges, found[0].edges);
    EXPECT_EQ(c.boundary_edges, found[0].boundary_edges);
    EXPECT_EQ(c.nonmanifold_edges, found[0].nonmanifold_edges);
    EXPECT_EQ(c.inconsistent_edges, found[0].inconsistent_edges);
    EXPECT_EQ(c.nonmanifold_vertices, found[0].nonmanifold_vertices);
    EXPECT_EQ(c.euler, found[0].euler);
  }
  EXPECT_EQ(tight[0], tight[1]);
  EXPECT_EQ(tight[0], tight[2]);
}

}  // namespace
}  // namespace dubsar
