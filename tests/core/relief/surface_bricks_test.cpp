#include "core/relief/occlusion/surface_bricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/base/system/parallel.h"
#include "tests/core/mesh/shape_meshes.h"

namespace dubsar {
namespace {
using namespace test;

SurfaceBricks bricks_of(const QuadMesh& mesh) {
  SilentProgress progress;
  auto out = SurfaceBricks::build(mesh.positions, split_quads(mesh), progress);
  EXPECT_TRUE(out) << out.error().message;
  return out ? *out : SurfaceBricks{};
}

struct CellWithSurface {
  glm::ivec3 at;  ///< in cells
  SurfaceBricks::Corners corners;
};

std::vector<CellWithSurface> cells_with_surface(const SurfaceBricks& bricks) {
  std::vector<CellWithSurface> out;
  const glm::ivec3 size = bricks.size();
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const auto [low, high] = bricks.bricks[bricks.index_of({x, y, z})];
        if ((low & SurfaceBricks::kSurface) == 0) continue;
        std::size_t cell =
            low % (1u << SurfaceBricks::kCellBits) + std::size_t{high & 0xffu} * (1u << SurfaceBricks::kCellBits);
        for (int k = 0; k < 8; ++k)
          if (low >> (SurfaceBricks::kCellBits + k) & 1)
            out.push_back({2 * glm::ivec3(x, y, z) + glm::ivec3(k & 1, k >> 1 & 1, k >> 2), bricks.corners[cell++]});
      }
  return out;
}

TEST(SurfaceBricks, CornersHoldTheDistanceFromABall) {
  std::mt19937 random(20261);
  std::uniform_real_distribution<double> place(-40, 40), size(9, 23);
  for (int round = 0; round < 3; ++round) {
    const glm::dvec3 middle(place(random), place(random), place(random));
    const double radius = size(random);
    const QuadMesh ball = cube_sphere(40, radius, middle);
    const SurfaceBricks bricks = bricks_of(ball);
    const auto cells = cells_with_surface(bricks);
    EXPECT_GT(cells.size(), 2 * 3.1 * radius * radius) << "less than half of the ball's great circles";
    for (const CellWithSurface& cell : cells)
      for (int k = 0; k < 8; ++k) {
        const glm::dvec3 corner =
            glm::dvec3(bricks.origin) + glm::dvec3(cell.at + glm::ivec3(k & 1, k >> 1 & 1, k >> 2));
        const double expected = glm::length(corner - middle) - radius;
        // Half a step, and what the flat pieces of the ball leave out.
        EXPECT_NEAR(cell.corners[static_cast<std::size_t>(k)] / 64.0, expected, 0.5 / 64 + 0.06);
      }
  }
}

TEST(SurfaceBricks, EveryCellThatTheSurfacePassesIsThere) {
  const glm::dvec3 middle(31.3, 30.2, 29.9);
  const double radius = 20.4;
  const SurfaceBricks bricks = bricks_of(cube_sphere(48, radius, middle));
  const auto cells = cells_with_surface(bricks);
  std::size_t expected = 0;
  for (int z = 0; z < 64; ++z)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        double low = 1e9, high = -1e9;
        for (int k = 0; k < 8; ++k) {
          const double d = glm::length(glm::dvec3(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)) - middle) - radius;
          low = std::min(low, d);
          high = std::max(high, d);
        }
        if (low > -0.06 || high < 0.06) continue;  // too near to say
        ++expected;
        const glm::ivec3 at = glm::ivec3(x, y, z) - glm::ivec3(bricks.origin);
        EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [&](const auto& c) { return c.at == at; }))
            << x << ' ' << y << ' ' << z;
      }
  EXPECT_GT(expected, 3000u);
}

TEST(SurfaceBricks, AheadIsTheLargestEmptyCubeOfEachOctant) {
  QuadMesh mesh = cube_sphere(16, 7, {9, 9, 9});
  // Far enough for slabs of slices, as threads do them.
  for (const glm::dvec3 middle : {glm::dvec3(95, 31, 20), glm::dvec3(12, 20, 330)}) {
    const QuadMesh other = cube_sphere(12, 4, middle);
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (auto q : other.quads) mesh.quads.push_back({q[0] + base, q[1] + base, q[2] + base, q[3] + base});
  }
  const SurfaceBricks bricks = bricks_of(mesh);
  std::vector<glm::ivec3> passed;
  for (const auto& cell : cells_with_surface(bricks))
    if (const glm::ivec3 brick = cell.at / 2; passed.empty() || passed.back() != brick) passed.push_back(brick);
  const glm::ivec3 size = bricks.size();
  ASSERT_GT(size.z, 4 * SurfaceBricks::kMostAhead);
  std::array<int, 8> far{}, near{};
  for (int z = 0; z < size.z; z += 3)
    for (int y = 0; y < size.y; y += 2)
      for (int x = 0; x < size.x; ++x) {
        const SurfaceBricks::Brick& brick = bricks.bricks[bricks.index_of({x, y, z})];
        if (brick[0] & SurfaceBricks::kSurface) continue;
        for (unsigned octant = 0; octant < 8; ++octant) {
          int expected = SurfaceBricks::kMostAhead;
          const glm::ivec3 way(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
          for (const glm::ivec3& other : passed) {
            const glm::ivec3 d = way * (other - glm::ivec3(x, y, z));
            if (std::min({d.x, d.y, d.z}) >= 0) expected = std::min(expected, std::max({d.x, d.y, d.z}));
          }
          ASSERT_EQ(brick[octant / 4] >> 8 * (octant % 4) & 0xff, static_cast<unsigned>(expected))
              << x << ' ' << y << ' ' << z << " octant " << octant;
          ++(expected == SurfaceBricks::kMostAhead ? far : near)[octant];
        }
      }
  for (std::size_t octant = 0; octant < 8; ++octant) {
    EXPECT_GT(far[octant], 0) << octant;
    EXPECT_GT(near[octant], 0) << octant;
  }
}

TEST(SurfaceBricks, ThreadsOrderAndLargeTrianglesChangeNothing) {
  const QuadMesh mesh = cube_sphere(20, 15, {3, 4, 5});
  std::vector<Triangle> triangles = split_quads(mesh);
  SilentProgress progress;
  const auto first = SurfaceBricks::build(mesh.positions, triangles, progress).value();
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(7));
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    const auto again = SurfaceBricks::build(mesh.positions, triangles, progress).value();
    EXPECT_EQ(again.corners, first.corners) << threads;
    EXPECT_EQ(again.bricks, first.bricks) << threads;
  }
  set_thread_count(0);
  // A plane of two triangles has the distances of one of many.
  const std::vector<glm::vec3> corners{{0, 0, 10.3f}, {60, 0, 10.3f}, {0, 60, 10.3f}, {60, 60, 10.3f}};
  const std::vector<Triangle> two{{0, 1, 2}, {1, 3, 2}};
  const auto plane = SurfaceBricks::build(corners, two, progress).value();
  const auto cells = cells_with_surface(plane);
  EXPECT_GE(cells.size(), 3600u);
  for (const auto& cell : cells) {
    EXPECT_EQ(cell.corners[0], std::lround(-0.3 * 64));
    EXPECT_EQ(cell.corners[7], std::lround(0.7 * 64));
  }
}

TEST(SurfaceBricks, NothingAndBrokenTrianglesAndCancel) {
  SilentProgress progress;
  EXPECT_TRUE(SurfaceBricks::build({}, {}, progress)->bricks.empty());
  const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {NAN, 1, 0}, {2, 0, 0}};
  const std::vector<Triangle> bad{{0, 1, 2}, {0, 1, 3}};
  EXPECT_TRUE(SurfaceBricks::build(positions, bad, progress)->bricks.empty());
  const std::vector<glm::vec3> huge{{0, 0, 0}, {1e6f, 0, 0}, {0, 1e6f, 1e6f}};
  const auto refused = SurfaceBricks::build(huge, std::vector<Triangle>{{0, 1, 2}}, progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kTryAgain);
  SilentProgress cancelled;
  cancelled.cancel();
  const QuadMesh mesh = cube_sphere(20, 15);
  const auto stopped = SurfaceBricks::build(mesh.positions, split_quads(mesh), cancelled);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
