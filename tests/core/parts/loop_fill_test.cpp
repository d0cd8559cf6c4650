#include "core/parts/fill/loop_fill.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "core/mesh/mesh_check.h"
#include "core/parts/border_loops.h"
#include "core/parts/fill/bridges.h"

namespace dubsar {
namespace {

constexpr double kPi = std::numbers::pi;

LoopFill fill(const Loop& loop, const LoopFillOptions& options) {
  SilentProgress progress;
  auto filled = fill_loop(loop, options, progress);
  EXPECT_TRUE(filled.has_value());
  return std::move(*filled);
}

glm::vec3 at(const Loop& loop, const LoopFill& filled, std::uint32_t v) {
  return v < loop.positions.size() ? loop.positions[v] : filled.added[v - loop.positions.size()];
}

/// A disk whose border runs once along the loop, in its sense.
void expect_disk(const Loop& loop, const LoopFill& filled) {
  std::vector<glm::vec3> positions = loop.positions;
  positions.insert(positions.end(), filled.added.begin(), filled.added.end());
  const MeshCheck check = check_mesh(positions, filled.triangles);
  EXPECT_TRUE(check.manifold());
  EXPECT_EQ(check.boundary_edges, static_cast<std::int64_t>(loop.positions.size()));
  EXPECT_EQ(check.euler, 1);
  EXPECT_EQ(check.components, 1);
  EXPECT_EQ(check.vertices, static_cast<std::int64_t>(positions.size()));
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (const Triangle& t : filled.triangles)
    for (std::size_t i = 0; i < 3; ++i) sides.emplace(t[i], t[(i + 1) % 3]);
  const auto n = static_cast<std::uint32_t>(loop.positions.size());
  for (std::uint32_t i = 0; i < n; ++i) EXPECT_EQ(sides.count({i, (i + 1) % n}), 1u) << i;
}

Loop circle(int n, float radius, const std::function<float(float)>& height, const std::function<float(float)>& scale) {
  Loop loop;
  for (int i = 0; i < n; ++i) {
    const float a = 2.0f * static_cast<float>(kPi) * static_cast<float>(i) / static_cast<float>(n);
    const float r = radius * scale(a);
    loop.positions.emplace_back(r * std::cos(a), r * std::sin(a), height(a));
  }
  return loop;
}
float zero(float) { return 0.0f; }
float one(float) { return 1.0f; }

std::vector<LoopFillOptions> variants() {
  std::vector<LoopFillOptions> all;
  for (const bool refine : {false, true}) {
    LoopFillOptions options;
    options.refine = refine;
    all.push_back(options);
  }
  return all;
}

TEST(LoopFill, PlanarPolygonHasItsExactAreaAndNoTriangleTurnedOver) {
  for (const LoopFillOptions& options : variants())
    for (const int n : {3, 4, 5, 17, 100}) {
      // A star shape with five lobes: not convex.
      const Loop loop = circle(n, 10.0f, zero, [](float a) { return 1.0f + 0.4f * std::cos(5.0f * a); });
      double area = 0.0;
      for (std::size_t i = 0; i < loop.positions.size(); ++i) {
        const glm::vec3 &p = loop.positions[i], &q = loop.positions[(i + 1) % loop.positions.size()];
        area += 0.5 * (static_cast<double>(p.x) * static_cast<double>(q.y) -
                       static_cast<double>(q.x) * static_cast<double>(p.y));
      }
      const LoopFill filled = fill(loop, options);
      expect_disk(loop, filled);
      EXPECT_NEAR(filled.area, area, 2e-5 * area);
      for (const Triangle& t : filled.triangles) {
        const glm::vec3 a = at(loop, filled, t[0]);
        EXPECT_GT(glm::cross(at(loop, filled, t[1]) - a, at(loop, filled, t[2]) - a).z, -1e-4f);
      }
    }
}

/// Area and bend of both surfaces by hand, for quadrilaterals of any shape.
TEST(LoopFill, AQuadrilateralTakesTheSurfaceOfLeastAreaAndBend) {
  std::mt19937 random(12);
  std::uniform_real_distribution<float> place(0.0f, 4.0f);
  for (int trial = 0; trial < 100; ++trial) {
    Loop loop;
    for (int i = 0; i < 4; ++i) loop.positions.emplace_back(place(random), place(random), place(random));
    const auto& p = loop.positions;
    LoopFillOptions options;
    options.refine = false;
    float perimeter = 0.0f;
    for (std::size_t i = 0; i < 4; ++i) perimeter += glm::distance(p[i], p[(i + 1) % 4]);
    struct Surface {
      float cost, area;
    };
    const auto split_at = [&](std::size_t a) {  // triangles (a, a + 1, a + 2) and (a, a + 2, a + 3)
      const glm::vec3 d = p[(a + 2) % 4] - p[a];
      const glm::vec3 m = glm::cross(p[(a + 1) % 4] - p[a], d), n = glm::cross(d, p[(a + 3) % 4] - p[a]);
      const float area = 0.5f * (glm::length(m) + glm::length(n));
      const float bend = 1.0f - glm::dot(glm::normalize(m), glm::normalize(n));
      return Surface{area + perimeter / 16.0f * bend * glm::length(d), area};
    };
    const Surface even = split_at(0), odd = split_at(1);
    const Surface least = even.cost < odd.cost ? even : odd;
    EXPECT_NEAR(fill(loop, options).area, static_cast<double>(least.area), 1e-5) << trial;
  }
}

TEST(LoopFill, RimOfAHemisphereIsClosedByADisk) {
  const Loop loop = circle(160, 20.0f, zero, one);
  for (const LoopFillOptions& options : variants()) {
    const LoopFill filled = fill(loop, options);
    expect_disk(loop, filled);
    EXPECT_NEAR(filled.area, kPi * 400.0, 1.0);
    if (options.refine) {
      EXPECT_GT(filled.added.size(), 100u);
    }
  }
}

TEST(LoopFill, ForbiddenEdgesAreNeverMade) {
  std::mt19937 random(4);
  for (const LoopFillOptions& options : variants())
    for (int trial = 0; trial < 20; ++trial) {
      Loop loop = circle(
          24, 10.0f, [](float a) { return 2.0f * std::sin(3.0f * a); }, one);
      std::set<std::pair<std::uint32_t, std::uint32_t>> taken;
      for (int i = 0; i < 60; ++i) {
        const auto a = static_cast<std::uint32_t>(random() % 24), b = static_cast<std::uint32_t>(random() % 24);
        taken.emplace(std::min(a, b), std::max(a, b));
      }
      loop.forbidden = [&](std::uint32_t a, std::uint32_t b) {
        return taken.count({std::min(a, b), std::max(a, b)}) > 0;
      };
      const LoopFill filled = fill(loop, options);
      expect_disk(loop, filled);
      for (const Triangle& t : filled.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
          const std::uint32_t a = std::min(t[i], t[(i + 1) % 3]), b = std::max(t[i], t[(i + 1) % 3]);
          if (b >= 24 || b == a + 1 || (a == 0 && b == 23)) continue;
          EXPECT_EQ(taken.count({a, b}), 0u);
        }
    }
}

TEST(LoopFill, AllInnerEdgesForbiddenGivesAStar) {
  Loop loop = circle(12, 5.0f, zero, one);
  loop.forbidden = [](std::uint32_t, std::uint32_t) { return true; };
  LoopFillOptions options;
  options.refine = false;
  const LoopFill filled = fill(loop, options);
  EXPECT_TRUE(filled.star);
  expect_disk(loop, filled);
}

TEST(LoopFill, RandomWigglyLoopsBecomeDisks) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> noise(-1.0f, 1.0f);
  for (int trial = 0; trial < 30; ++trial) {
    const int n = 3 + static_cast<int>(random() % 300);
    Loop loop = circle(
        n, 12.0f, [&](float) { return noise(random); }, [&](float) { return 1.0f + 0.15f * noise(random); });
    for (std::size_t i = 0; i < loop.positions.size(); ++i)
      loop.rim_normals.push_back(glm::normalize(glm::vec3(noise(random), noise(random), 2.0f)));
    LoopFillOptions options;
    options.refine = trial % 2 == 0;
    options.exact_limit = trial % 3 == 0 ? 40 : 256;
    expect_disk(loop, fill(loop, options));
  }
}

/// Of a ball around the origin: where a curve on it goes, and its normals there.
Loop on_ball(float radius, int steps, const std::function<glm::vec3(float)>& direction) {
  const auto at_step = [&](float i) {
    return glm::normalize(direction(2.0f * static_cast<float>(kPi) * i / static_cast<float>(steps)));
  };
  Loop loop;
  for (int i = 0; i < steps; ++i) {
    loop.positions.push_back(radius * at_step(static_cast<float>(i)));
    loop.rim_normals.push_back(at_step(static_cast<float>(i) + 0.5f));
  }
  return loop;
}

float farthest_from_ball(const LoopFill& filled, float radius) {
  float worst = 0.0f;
  for (const glm::vec3& p : filled.added) worst = std::max(worst, std::abs(glm::length(p) - radius));
  return worst;
}

TEST(LoopFill, ALargeBentPatchContinuesTheBall) {
  constexpr float kRadius = 30.0f;
  struct Band {
    float half_length, middle, half_width;  // radians along the parallel, from the pole, and across
    double within;                          // of the radius
  };
  for (const Band& band :
       {Band{1.2f, 0.8f, 0.3f, 0.001}, Band{1.2f, 1.2f, 0.7f, 0.01}, Band{1.6f, 1.6f, 0.5f, 0.002},
        Band{2.0f, 0.8f, 0.7f, 0.005}, Band{2.0f, 1.2f, 0.5f, 0.025}, Band{2.0f, 1.6f, 0.7f, 0.025}}) {
    const Loop loop = on_ball(kRadius, 300, [&](float a) {
      const float along = band.half_length * std::cos(a), across = band.middle + band.half_width * std::sin(a);
      return glm::vec3(std::cos(along) * std::sin(across), std::sin(along) * std::sin(across), std::cos(across));
    });
    const LoopFill filled = fill(loop, {});
    expect_disk(loop, filled);
    EXPECT_LT(farthest_from_ball(filled, kRadius), band.within * kRadius) << band.half_length << ' ' << band.middle;
  }
}

/// Two rims and a bridge from the first vertex of one to the first of the other.
Loop with_island(const Loop& rim, const Loop& island) {
  Loop both = rim;
  const auto n = static_cast<std::uint32_t>(rim.positions.size()),
             m = static_cast<std::uint32_t>(island.positions.size());
  both.positions.insert(both.positions.end(), island.positions.begin(), island.positions.end());
  both.rim_normals.emplace_back(0.0f);
  both.rim_normals.insert(both.rim_normals.end(), island.rim_normals.begin(), island.rim_normals.end());
  both.rim_normals.emplace_back(0.0f);
  for (std::uint32_t i = 0; i <= n; ++i) both.walk.push_back(i % n);
  for (std::uint32_t i = 0; i <= m; ++i) both.walk.push_back(n + i % m);
  both.forbidden = [n](std::uint32_t a, std::uint32_t b) { return std::min(a, b) == 0 && std::max(a, b) == n; };
  return both;
}

TEST(LoopFill, AHoleWithAnIslandIsClosedAroundIt) {
  constexpr float kRadius = 30.0f;
  const Loop rim = on_ball(kRadius, 200, [](float a) { return glm::vec3(std::cos(a), std::sin(a), 0.3f); });
  const Loop island =
      on_ball(kRadius, 70, [](float a) { return glm::vec3(0.3f * std::cos(a) + 0.15f, -0.3f * std::sin(a), 1.0f); });
  for (const int limit : {40, 256, 512}) {
    const Loop loop = with_island(rim, island);
    LoopFillOptions options;
    options.exact_limit = limit;
    const LoopFill filled = fill(loop, options);
    ASSERT_FALSE(filled.doubled);
    std::vector<glm::vec3> positions = loop.positions;
    positions.insert(positions.end(), filled.added.begin(), filled.added.end());
    const MeshCheck check = check_mesh(positions, filled.triangles);
    EXPECT_TRUE(check.manifold());
    EXPECT_EQ(check.components, 1);
    EXPECT_EQ(check.euler, 0);
    EXPECT_EQ(check.boundary_edges, 270);
    EXPECT_EQ(check.vertices, static_cast<std::int64_t>(positions.size()));
    EXPECT_LT(farthest_from_ball(filled, kRadius), 0.03f * kRadius) << limit;
    for (const Triangle& t : filled.triangles) {  // none lies over the island
      const glm::vec3 middle = (at(loop, filled, t[0]) + at(loop, filled, t[1]) + at(loop, filled, t[2])) / 3.0f;
      if (middle.z < 0.0f) continue;
      EXPECT_GT(glm::length(glm::vec2(middle.x, middle.y) / middle.z - glm::vec2(0.15f, 0.0f)), 0.27f);
    }
  }
}

TEST(JoinIslands, EachIslandHangsByTheNearestRimOfAnotherPiece) {
  const auto ring = [](std::vector<glm::vec3>& positions, const glm::vec3& middle, float radius, int steps,
                       std::uint32_t piece) {
    HoleRim rim;
    rim.piece = piece;
    for (int i = 0; i < steps; ++i) {
      const float a = 2.0f * static_cast<float>(kPi) * static_cast<float>(i) / static_cast<float>(steps);
      rim.vertices.push_back(static_cast<std::uint32_t>(positions.size()));
      rim.normals.emplace_back(0.0f, 0.0f, 1.0f);
      positions.push_back(middle + radius * glm::vec3(std::cos(a), std::sin(a), 0.0f));
    }
    return rim;
  };
  std::vector<glm::vec3> positions;
  std::vector<HoleRim> rims;
  rims.push_back(ring(positions, {0, 0, 0}, 10.0f, 40, 0));
  rims.push_back(ring(positions, {50, 0, 0}, 10.0f, 40, 0));  // another hole of the same body
  rims.push_back(ring(positions, {5, 0, 0}, 3.0f, 20, 1));    // 2 from the first
  rims.push_back(ring(positions, {-2, 0, 0}, 2.0f, 15, 2));   // 2 from the island
  rims.push_back(ring(positions, {100, 0, 0}, 5.0f, 20, 3));  // another body
  const auto any = [](std::uint32_t, std::uint32_t) { return true; };
  const std::vector<bool> island{false, true, true, false};
  const std::vector<JoinedRims> joined = join_islands(rims, island, positions, any);
  ASSERT_EQ(joined.size(), 3u);
  std::vector<std::vector<std::uint32_t>> members;
  for (const JoinedRims& one : joined) {
    members.push_back(one.members);
    std::sort(members.back().begin(), members.back().end());
    EXPECT_EQ(one.rim.normals.size(), one.rim.vertices.size());
  }
  EXPECT_EQ(members, (std::vector<std::vector<std::uint32_t>>{{0, 2, 3}, {1}, {4}}));
  EXPECT_EQ(joined[0].rim.vertices.size(), 40u + 20 + 15 + 4);
  EXPECT_EQ(std::count(joined[0].rim.normals.begin(), joined[0].rim.normals.end(), glm::vec3(0.0f)), 4);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> steps;
  float longest = 0.0f;
  for (std::size_t i = 0; i < joined[0].rim.vertices.size(); ++i) {
    const std::uint32_t a = joined[0].rim.vertices[i],
                        b = joined[0].rim.vertices[(i + 1) % joined[0].rim.vertices.size()];
    ++steps[{a, b}];
    longest = std::max(longest, glm::distance(positions[a], positions[b]));
  }
  EXPECT_EQ(steps.size(), joined[0].rim.vertices.size()) << "every step once in its sense";
  EXPECT_LT(longest, 2.1f) << "bridges are the shortest ways";

  const auto none = [](std::uint32_t, std::uint32_t) { return false; };
  EXPECT_EQ(join_islands(rims, island, positions, none).size(), rims.size());
}

TEST(LoopFill, LoopOfThirtyThousandVerticesIsCutDownFirst) {
  const Loop loop = circle(
      30000, 4000.0f, [](float a) { return 30.0f * std::sin(7.0f * a); },
      [](float a) { return 1.0f + 0.1f * std::sin(40.0f * a); });
  LoopFillOptions options;
  options.refine = false;
  const LoopFill filled = fill(loop, options);
  expect_disk(loop, filled);
  EXPECT_NEAR(filled.area, kPi * 16e6 * 1.005, 0.01 * kPi * 16e6);
}

TEST(BorderLoops, FigureEightBecomesTwoLoopsThatVisitNoVertexTwice) {
  // 0 -> 1 -> 2 -> 0 -> 3 -> 4 -> 0, and a separate triangle; shuffled.
  const std::vector<BorderEdge> edges{{3, 4}, {1, 2}, {7, 5}, {0, 3}, {2, 0}, {5, 6}, {4, 0}, {6, 7}, {0, 1}};
  const auto loops = join_loops(edges);
  ASSERT_EQ(loops.size(), 3u);
  std::size_t used = 0;
  for (const auto& loop : loops) {
    EXPECT_EQ(loop.size(), 3u);
    used += loop.size();
    for (std::size_t i = 0; i < loop.size(); ++i) EXPECT_EQ(edges[loop[i]].to, edges[loop[(i + 1) % loop.size()]].from);
  }
  EXPECT_EQ(used, edges.size());
}

TEST(BorderLoops, PathsThatEndAtAnOpenBoundaryAreLeftOut) {
  const std::vector<BorderEdge> edges{{9, 8}, {8, 0}, {0, 1}, {1, 2}, {2, 0}, {2, 5}};
  const auto loops = join_loops(edges);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].size(), 3u);
}

}  // namespace
}  // namespace dubsar
