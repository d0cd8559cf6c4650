// Shares of balls inside of bodies whose volumes are known.

#include "core/relief/curvature/integral_invariants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <numbers>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// A body of cubes' faces: the box (0, 0, 0) to `size`, `step` between vertices, each face a grid of its own joined at
/// the edges.
TriMesh box(const glm::ivec3& size, float step) {
  TriMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> ids;
  const auto id = [&](const glm::ivec3& p) {
    const auto [at, made] = ids.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(mesh.positions.size()));
    if (made) mesh.positions.push_back(step * glm::vec3(p));
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i < size[u]; ++i)
        for (int j = 0; j < size[v]; ++j) {
          glm::ivec3 a(0);
          a[axis] = side * size[axis];
          a[u] = i;
          a[v] = j;
          glm::ivec3 b = a, c = a, d = a;
          b[u] += 1;
          c[u] += 1;
          c[v] += 1;
          d[v] += 1;
          Triangle first{id(a), id(b), id(c)}, second{id(a), id(c), id(d)};
          if (side == 0) {
            std::swap(first[1], first[2]);
            std::swap(second[1], second[2]);
          }
          mesh.triangles.push_back(first);
          mesh.triangles.push_back(second);
        }
    }
  return mesh;
}

std::size_t vertex_at(const TriMesh& mesh, const glm::vec3& at) {
  std::size_t best = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (glm::distance(mesh.positions[v], at) < glm::distance(mesh.positions[best], at)) best = v;
  EXPECT_LT(glm::distance(mesh.positions[best], at), 1e-4f);
  return best;
}

/// The surface of a cube blown up to a ball: triangles of nearly one size.
TriMesh ball(int cells, float radius) {
  TriMesh mesh = box(glm::ivec3(cells), 2.0f / static_cast<float>(cells));
  for (glm::vec3& p : mesh.positions) p = radius * glm::normalize(glm::tan(0.78539816f * (p - 1.0f)));
  return mesh;
}

std::vector<InvariantShares> invariants(const TriMesh& mesh, double radius_mm) {
  SilentProgress progress;
  return integral_invariants(mesh, radius_mm, progress).value();
}

TEST(IntegralInvariants, APlaneFillsHalfOfEveryBall) {
  const TriMesh mesh = box({80, 80, 80}, 0.1f);
  const auto share = invariants(mesh, 1.0)[vertex_at(mesh, {4.0f, 4.0f, 8.0f})];
  for (const float s : share) EXPECT_NEAR(s, 0.5, 1e-4);
  EXPECT_NEAR(distance_from_plane(share), 0.0, 1e-4);
}

TEST(IntegralInvariants, OnABallTheyAreThoseOfItsCaps) {
  // The part of a ball of radius r inside of one of radius R whose surface it is centred on: 1/2 - 3 r / (16 R).
  for (const float radius : {4.0f, 2.5f}) {
    const TriMesh mesh = ball(48, radius);
    const double largest = 1.3;
    const auto all = invariants(mesh, largest);
    double worst = 0.0;
    for (std::size_t v = 0; v < all.size(); ++v)
      for (std::size_t k = 0; k < kInvariantScales; ++k) {
        const double r = largest * static_cast<double>(k + 1) / 4.0;
        worst = std::max(worst, std::abs(all[v][k] - (0.5 - 3.0 * r / (16.0 * radius))));
      }
    EXPECT_LT(worst, 0.006) << radius;
    EXPECT_GT(distance_from_plane(all[0]), 0.02f) << "convex";
  }
}

TEST(IntegralInvariants, HollowsAreTheOtherWayRound) {
  TriMesh mesh = ball(48, 4.0f);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const auto share = invariants(mesh, 1.2)[7];
  for (std::size_t k = 0; k < kInvariantScales; ++k)
    EXPECT_NEAR(share[k], 0.5 + 3.0 * (0.3 * static_cast<double>(k + 1)) / 64.0, 0.006);
  EXPECT_LT(distance_from_plane(share), -0.02f);
}

TEST(IntegralInvariants, AnEdgeHasItsAngleAndACornerItsSolidAngle) {
  const TriMesh mesh = box({60, 60, 60}, 0.1f);
  const auto all = invariants(mesh, 1.0);
  for (const float s : all[vertex_at(mesh, {3.0f, 6.0f, 6.0f})]) EXPECT_NEAR(s, 0.25, 2e-3) << "90 of 360 degrees";
  for (const float s : all[vertex_at(mesh, {6.0f, 6.0f, 6.0f})]) EXPECT_NEAR(s, 0.125, 3e-3) << "an eighth";
  // 0.5 beside the edge: the ball of radius 1 loses the cap beyond x = 0.5 of its lower half.
  const double cap = std::numbers::pi * 0.25 * (3.0 - 0.5) / 3.0 / (4.0 / 3.0 * std::numbers::pi);
  EXPECT_NEAR(all[vertex_at(mesh, {3.0f, 5.5f, 6.0f})][3], 0.5 - 0.5 * cap, 4e-3);
}

TEST(IntegralInvariants, FineMeshesAreMergedFarAway) {
  const TriMesh mesh = ball(120, 4.0f);  // 0.05 mm between vertices: cells of 1 / 12 hold several
  const auto all = invariants(mesh, 1.2);
  for (std::size_t v = 0; v < all.size(); v += 97)
    for (std::size_t k = 0; k < kInvariantScales; ++k)
      ASSERT_NEAR(all[v][k], 0.5 - 3.0 * (0.3 * static_cast<double>(k + 1)) / 64.0, 0.004) << v << " " << k;
}

TEST(IntegralInvariants, BodiesDoNotSeeEachOther) {
  TriMesh mesh = box({60, 60, 60}, 0.1f);
  const std::size_t at = vertex_at(mesh, {3.0f, 3.0f, 6.0f});
  const auto alone = invariants(mesh, 1.0);
  const TriMesh other = box({60, 60, 10}, 0.1f);  // 0.3 mm above it
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const std::size_t triangles = mesh.triangles.size();
  for (const glm::vec3& p : other.positions) mesh.positions.push_back(p + glm::vec3(0, 0, 6.3f));
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  mesh.triangle_partition.assign(mesh.triangles.size(), 1);
  std::fill_n(mesh.triangle_partition.begin(), triangles, PartitionId{0});
  EXPECT_EQ(invariants(mesh, 1.0)[at], alone[at]);
  mesh.triangle_partition.clear();
  EXPECT_GT(invariants(mesh, 1.0)[at][3], alone[at][3] + 0.1f);
}

TEST(IntegralInvariants, SameForAnyNumberOfThreads) {
  const TriMesh mesh = ball(30, 3.0f);
  set_thread_count(1);
  const auto one = invariants(mesh, 1.0);
  set_thread_count(3);
  EXPECT_EQ(invariants(mesh, 1.0), one);
  set_thread_count(0);
}

TEST(IntegralInvariants, RefusesRadiiAndStopsWhenToldTo) {
  const TriMesh mesh = ball(10, 3.0f);
  SilentProgress progress;
  for (const double radius : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(integral_invariants(mesh, radius, progress).error().kind, ErrorKind::kUsage);
  progress.cancel();
  EXPECT_EQ(integral_invariants(mesh, 1.0, progress).error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
