#include "core/mesh/intersections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace dubsar {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// A sphere of triangles between rings, moved by `centre`.
void add_sphere(const glm::vec3& centre, float radius, std::vector<glm::vec3>& positions, Triangles& triangles) {
  constexpr std::uint32_t kRings = 24, kAround = 48;
  const auto base = static_cast<std::uint32_t>(positions.size());
  for (std::uint32_t i = 0; i <= kRings; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const float theta = 3.14159265f * (static_cast<float>(i) + 0.01f) / (kRings + 0.02f),
                  phi = 6.2831853f * static_cast<float>(j) / kAround;
      positions.push_back(centre + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                                      std::cos(theta)));
    }
  for (std::uint32_t i = 0; i < kRings; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t a = base + i * kAround + j, b = base + i * kAround + (j + 1) % kAround;
      triangles.push_back({a, a + kAround, b});
      triangles.push_back({b, a + kAround, b + kAround});
    }
}

TEST(SelfIntersections, SpheresThatOverlapMeetAlongACircleAndThoseBesideDoNot) {
  std::vector<glm::vec3> positions;
  Triangles triangles;
  add_sphere({0.1f, 0.2f, 0.3f}, 5.0f, positions, triangles);
  const std::size_t one = triangles.size();
  add_sphere({20.0f, 0.0f, 0.0f}, 5.0f, positions, triangles);
  EXPECT_TRUE(self_intersections(positions, triangles).empty());
  add_sphere({6.1f, 0.37f, 0.21f}, 5.0f, positions, triangles);
  const Pairs pairs = self_intersections(positions, triangles);
  EXPECT_GT(pairs.size(), 40u);
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, one);
    EXPECT_GE(b, 2 * one);
    const glm::vec3 p = positions[triangles[a][0]];
    EXPECT_NEAR(glm::distance(p, {6.1f, 0.37f, 0.21f}), 5.0f, 1.2f);
  }
}

TEST(SelfIntersections, TouchingIsNotCrossing) {
  const std::vector<glm::vec3> positions{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}, {1, 1, 1}, {0.5f, 0.5f, 0}};
  EXPECT_TRUE(self_intersections(positions, Triangles{{0, 1, 2}, {3, 4, 5}}).empty());
  std::vector<glm::vec3> through = positions;
  through[5].z = -0.1f;
  EXPECT_EQ(self_intersections(through, Triangles{{0, 1, 2}, {3, 4, 5}}), (Pairs{{0, 1}}));
  // With one vertex in common the sides that leave it do not count, but the one across does.
  const std::vector<glm::vec3> fan{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5f, 0.5f, 1}, {0.5f, 0.5f, -1}};
  EXPECT_EQ(self_intersections(fan, Triangles{{0, 1, 2}, {0, 3, 4}}), (Pairs{{0, 1}}));
}

// Oracle: every pair.
TEST(SelfIntersections, TheTreeFindsWhatAllPairsFind) {
  std::mt19937 random(977);
  std::uniform_real_distribution<float> place(0.0f, 10.0f), size(-1.5f, 1.5f);
  std::vector<glm::vec3> positions;
  Triangles triangles;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const glm::vec3 p(place(random), place(random), place(random));
    for (int k = 0; k < 3; ++k) positions.push_back(p + glm::vec3(size(random), size(random), size(random)));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  Pairs expected;
  for (std::uint32_t a = 0; a < triangles.size(); ++a)
    for (std::uint32_t b = a + 1; b < triangles.size(); ++b)
      if (!self_intersections(positions, Triangles{triangles[a], triangles[b]}).empty()) expected.push_back({a, b});
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(self_intersections(positions, triangles), expected);
}

}  // namespace
}  // namespace dubsar
