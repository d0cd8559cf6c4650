#include "core/extract/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "tests/core/extract/extract_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

QuadMesh one_quad(std::vector<glm::vec3> positions, std::vector<DoubledCorner> doubled = {}) {
  QuadMesh mesh;
  mesh.positions = std::move(positions);
  mesh.quads = {{0, 1, 2, 3}};
  mesh.doubled = std::move(doubled);
  mesh.build_incidence();
  return mesh;
}

/// True: both triangles hold vertices a and b.
bool diagonal_is(const Triangulation& cut, std::uint32_t a, std::uint32_t b) {
  int found = 0;
  for (const Triangle& t : cut.triangles) {
    found += std::ranges::count(t, a) == 1 && std::ranges::count(t, b) == 1;
  }
  return cut.triangles.size() == 2 && found == 2;
}

TEST(Triangulate, ConcaveQuadsAreCutAtTheReflexCorner) {
  for (std::size_t reflex = 0; reflex < 4; ++reflex) {
    std::vector<glm::vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square[reflex] = glm::vec3(0.5f, 0.5f, 0.0f) + 0.2f * (glm::vec3(0.5f, 0.5f, 0.0f) - square[reflex]);
    const auto a = static_cast<std::uint32_t>(reflex);
    const std::vector<glm::vec3> up(4, glm::vec3(0, 0, 1));
    EXPECT_TRUE(diagonal_is(triangulate(one_quad(square), {}), a, (a + 2) % 4)) << reflex;
    EXPECT_TRUE(diagonal_is(triangulate(one_quad(square), up), a, (a + 2) % 4)) << reflex;
  }
}

TEST(Triangulate, TheCreaseFollowsTheCurvatureOfTheNormals) {
  // A quad of a cylinder turned by 30 degrees against the grid: the diagonal along the ruling is nearer to it.
  for (const float sign : {1.0f, -1.0f}) {     // ridge and valley
    for (const float slope : {0.6f, -0.6f}) {  // direction of the ruling
      const auto cylinder = [&](float x, float y) {
        const float u = (x * slope - y) / std::sqrt(1 + slope * slope);  // distance from the ruling through 0
        return std::pair(glm::vec3(x, y, -sign * 0.5f * u * u),
                         glm::normalize(glm::vec3(sign * u * slope, -sign * u, std::sqrt(1 + slope * slope))));
      };
      std::vector<glm::vec3> positions, normals;
      for (const auto& [x, y] : {std::pair{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}}) {
        positions.push_back(cylinder(x, y).first);
        normals.push_back(cylinder(x, y).second);
      }
      const Triangulation cut = triangulate(one_quad(positions), normals);
      EXPECT_TRUE(slope > 0 ? diagonal_is(cut, 0, 2) : diagonal_is(cut, 1, 3)) << sign << " " << slope;
    }
  }
}

TEST(Triangulate, TiesTakeTheLowestVertex) {
  const std::vector<glm::vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_TRUE(diagonal_is(triangulate(one_quad(square), {}), 0, 2));
  QuadMesh turned = one_quad(square);
  turned.quads[0] = {1, 2, 3, 0};
  EXPECT_TRUE(diagonal_is(triangulate(turned, {}), 0, 2));
}

TEST(Triangulate, SplitCornersUseOnlyDiagonalsBetweenOppositeCorners) {
  std::size_t star = 0, strip = 0;
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    QuadMesh mesh = build(sample(random_volume({30, 30, 30}, seed, 0), 0.0f));
    mesh.embedded = false;
    const Triangulation cut = triangulate(mesh, {});
    ASSERT_EQ(cut.first_triangle.size(), mesh.quads.size() + 1);
    for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
      const Polygon polygon = mesh.polygon(q);
      const auto n = static_cast<std::size_t>(polygon.size);
      std::map<std::uint32_t, unsigned> corner_of;
      std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
      std::set<unsigned> doubled;
      for (std::size_t i = 0; i < n; ++i) {
        corner_of[polygon.vertex[i]] = polygon.corner[i];
        sides.insert({polygon.vertex[i], polygon.vertex[(i + 1) % n]});
        if (polygon.corner[i] == polygon.corner[(i + 1) % n]) doubled.insert(polygon.corner[i]);
      }
      const bool adjacent = std::ranges::any_of(doubled, [&](unsigned c) { return doubled.contains((c + 1) % 4); });
      const std::size_t triangles = cut.first_triangle[q + 1] - cut.first_triangle[q];
      EXPECT_EQ(triangles, adjacent ? n : n - 2);
      (adjacent ? star : strip) += !doubled.empty();
      for (std::uint32_t t = cut.first_triangle[q]; t < cut.first_triangle[q + 1]; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t v = cut.triangles[t][k], w = cut.triangles[t][(k + 1) % 3];
          if (v >= mesh.positions.size() || w >= mesh.positions.size()) continue;
          if (sides.erase({v, w}) == 1) continue;
          EXPECT_FALSE(adjacent) << "a star has no diagonal";
          EXPECT_EQ((corner_of.at(v) + 2) % 4, corner_of.at(w));
        }
      }
      EXPECT_TRUE(sides.empty()) << "a side of the polygon has no triangle";
    }
  }
  EXPECT_GT(star, 100u);
  EXPECT_GT(strip, 100u);
}

}  // namespace
}  // namespace dubsar
