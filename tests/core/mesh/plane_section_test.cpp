// Cuts of surfaces whose cuts are known.

#include "core/mesh/plane_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

namespace dubsar {
namespace {

TriMesh sphere(double radius, int rings) {
  TriMesh out;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / around;
      out.positions.emplace_back(radius * std::sin(a) * std::cos(b), radius * std::sin(a) * std::sin(b),
                                 radius * std::cos(a));
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * around + j % around); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      if (i > 0) out.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rings) out.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  return out;
}

TEST(PlaneSection, OfASphereIsItsCircleInMillimetres) {
  TriMesh mesh = sphere(50.0, 200);
  mesh.frame.scale = {2, 2, 2};
  mesh.frame.origin_vox = {100, 120, 140};
  mesh.frame.input_voxel = {{0.05, 0.05, 0.05}, "test"};
  const glm::dvec3 centre = 0.05 * glm::dvec3(100, 120, 140), normal = glm::normalize(glm::dvec3(1, 2, -0.5));
  for (const double off : {0.0, 1.0, -3.7}) {
    const auto cut = plane_section(mesh, centre + off * normal, 3.0 * normal);
    const double radius = std::sqrt(25.0 - off * off);
    ASSERT_GT(cut.size(), 300u);
    double length = 0.0;
    for (const SectionPiece& piece : cut) {
      length += glm::distance(piece.a_mm, piece.b_mm);
      for (const glm::dvec3& p : {piece.a_mm, piece.b_mm}) {
        EXPECT_NEAR(glm::dot(p - centre, normal), off, 1e-9);
        EXPECT_NEAR(glm::distance(p, centre + off * normal), radius, 0.002);  // chords of the mesh
      }
      EXPECT_LT(piece.triangle, mesh.triangles.size());
    }
    EXPECT_NEAR(length, 2 * std::numbers::pi * radius, 0.01);
  }
  EXPECT_TRUE(plane_section(mesh, centre + 5.001 * normal, normal).empty());
}

// Planes through vertices: every end is the end of two pieces.
TEST(PlaneSection, OfAClosedSurfaceIsClosedAlsoThroughItsVertices) {
  TriMesh box;
  for (int i = 0; i < 8; ++i) box.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  for (const auto& q : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3},
                        std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    const auto u = [&](std::size_t i) { return static_cast<std::uint32_t>(q[i]); };
    box.triangles.push_back({u(0), u(1), u(2)});
    box.triangles.push_back({u(0), u(2), u(3)});
  }
  for (const glm::dvec3 normal : {glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 0), glm::dvec3(1, 1, 1), glm::dvec3(1, -1, 0)})
    for (const double off : {0.0, 0.3, 0.5}) {
      std::map<std::array<long, 3>, int> ends;
      const auto cut = plane_section(box, glm::dvec3(off), normal);
      for (const SectionPiece& piece : cut)
        for (const glm::dvec3& p : {piece.a_mm, piece.b_mm})
          if (glm::distance(piece.a_mm, piece.b_mm) > 1e-12)
            ++ends[{std::lround(p.x * 1e9), std::lround(p.y * 1e9), std::lround(p.z * 1e9)}];
      for (const auto& [at, times] : ends) EXPECT_EQ(times % 2, 0);
    }
}

}  // namespace
}  // namespace dubsar
