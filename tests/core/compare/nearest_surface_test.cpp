#include "core/compare/nearest_surface.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "core/compare/surface_alignment.h"
#include "tests/core/compare/compared_lump.h"

namespace dubsar {
namespace {

TEST(NearestSurface, IsTheNearestOfAllTriangles) {
  const TriMesh mesh = lump(24, 0.0, {});
  const std::vector<glm::dvec3> points = points_mm(mesh);
  const NearestSurface surface(points, mesh.triangles);
  std::mt19937 random(40106);
  std::uniform_real_distribution<double> any(-40.0, 40.0);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 p(any(random), any(random), any(random));
    double best = 1e300;  // by looking at each of them
    for (const Triangle& t : mesh.triangles)
      best = std::min(best, glm::distance(p, nearest_on_triangle(p, points[t[0]], points[t[1]], points[t[2]])));
    const NearPlace found = surface.nearest(p);
    EXPECT_DOUBLE_EQ(found.distance_mm, best);
    EXPECT_NEAR(glm::distance(p, found.at_mm), best, 1e-12);
    EXPECT_NEAR(glm::length(found.normal), 1.0, 1e-9);
    EXPECT_EQ(surface.nearest(p, 0.5 * best).distance_mm, std::numeric_limits<double>::max());
  }
}

TEST(NearestSurface, OnATriangleItIsNoFartherThanAnyOfItsPlaces) {
  std::mt19937 random(40107);
  std::uniform_real_distribution<double> any(-1.0, 1.0), share(0.0, 1.0);
  const auto point = [&] { return glm::dvec3(any(random), any(random), any(random)); };
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 a = point(), b = point(), c = point(), p = point();
    const double found = glm::distance(p, nearest_on_triangle(p, a, b, c));
    for (int k = 0; k < 100; ++k) {
      double u = share(random), v = share(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      EXPECT_LE(found, glm::distance(p, a + u * (b - a) + v * (c - a)) + 1e-12);
    }
  }
}

}  // namespace
}  // namespace dubsar
