#include "core/compare/surface_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/core/compare/compared_lump.h"

namespace dubsar {
namespace {

RigidMotion any_motion(std::mt19937& random) {
  std::normal_distribution<double> normal;
  glm::dvec3 x(normal(random), normal(random), normal(random)), y(normal(random), normal(random), normal(random));
  x = glm::normalize(x);
  y = glm::normalize(y - glm::dot(x, y) * x);
  return {{x, y, glm::cross(x, y)}, {30.0 * normal(random), 30.0 * normal(random), 30.0 * normal(random)}};
}

TEST(SurfaceDifference, AnyAttitudeIsFoundAndTheSameShapeDiffersByItsTrianglesAlone) {
  std::mt19937 random(40108);
  const TriMesh a = lump(90, 0.0, {});
  for (int n = 0; n < 4; ++n) {
    const RigidMotion moved = any_motion(random);
    const TriMesh b = lump(83, 0.1, moved);
    SilentProgress progress;
    const SurfaceDifference found = difference_of(a, b, 2.0, progress).value();
    const RigidMotion both = after(found.alignment.a_from_b, moved);  // from the lump to itself: nothing
    EXPECT_LT(angle_deg(both), 0.02) << n;
    EXPECT_LT(glm::length(both.shift), 0.01) << n;
    EXPECT_LT(found.rms_mm, 0.02) << n;
    EXPECT_GT(found.within_05, 0.99) << n;
    EXPECT_EQ(found.left_out_mm2, 0.0) << n;
  }
}

TEST(SurfaceDifference, ADentAndALumpHaveTheirDepthsAndSigns) {
  std::mt19937 random(40109);
  // 0.4 mm less round one direction, 0.3 mm more round another one; each on a twentieth of the surface or so.
  const glm::dvec3 dent = glm::normalize(glm::dvec3(0.2, 0.3, 1.0)), more = glm::normalize(glm::dvec3(-0.4, 0.2, -1.0));
  const auto change = [&](const glm::dvec3& d) {
    return (glm::dot(d, dent) > 0.97 ? -0.4 : 0.0) + (glm::dot(d, more) > 0.97 ? 0.3 : 0.0);
  };
  const TriMesh a = lump(90, 0.0, {});
  const RigidMotion moved = any_motion(random);
  const TriMesh b = lump(97, 0.05, moved, change);
  SilentProgress progress;
  const SurfaceDifference found = difference_of(a, b, 2.0, progress).value();
  const RigidMotion both = after(found.alignment.a_from_b, moved);
  EXPECT_LT(angle_deg(both), 0.05);
  EXPECT_LT(glm::length(both.shift), 0.02);
  double least = 1.0, most = -1.0;
  int dents = 0, lumps = 0;
  for (std::size_t v = 0; v < b.positions.size(); ++v) {
    const double mm = found.vertex_mm[v];
    least = std::min(least, mm);
    most = std::max(most, mm);
    dents += mm < -0.35 ? 1 : 0;
    lumps += mm > 0.25 ? 1 : 0;
  }
  EXPECT_NEAR(least, -0.4, 0.03);
  EXPECT_NEAR(most, 0.3, 0.03);
  EXPECT_GT(dents, 30);
  EXPECT_GT(lumps, 30);
  EXPECT_GT(found.most_mm, 0.25);
  EXPECT_LT(found.median_mm, 0.01);
}

TEST(SurfaceDifference, WhatTheScanDoesNotShowAndWhatWasLostAreLeftOut) {
  const TriMesh a = lump(60, 0.0, {});
  TriMesh b = lump(60, 0.03, {}, [](const glm::dvec3& d) { return d.x > 0.9 ? -3.0 : 0.0; });
  b.triangle_inferred.assign(b.triangles.size(), 0);
  for (std::size_t t = 0; t < 200; ++t) b.triangle_inferred[t] = 1;
  SilentProgress progress;
  const SurfaceDifference found = difference_of(a, b, 1.0, progress).value();
  EXPECT_GT(found.left_out_mm2, 0.0);
  EXPECT_TRUE(std::isnan(found.vertex_mm[b.triangles[100][0]]));
  EXPECT_LE(found.most_mm, 1.0);
  const TriMesh nothing;
  EXPECT_FALSE(difference_of(a, nothing, 1.0, progress));
}

TEST(SurfaceDifference, ColoursTellTheSign) {
  EXPECT_EQ(difference_color(0.0, 0.2), (std::array<std::uint8_t, 3>{245, 245, 245}));
  EXPECT_EQ(difference_color(-0.2, 0.2), difference_color(-5.0, 0.2)) << "full at the range";
  EXPECT_GT(difference_color(-0.2, 0.2)[2], difference_color(-0.2, 0.2)[0]) << "less clay is blue";
  EXPECT_GT(difference_color(0.2, 0.2)[0], difference_color(0.2, 0.2)[2]) << "more is orange";
  EXPECT_EQ(difference_color(NAN, 0.2), (std::array<std::uint8_t, 3>{128, 128, 128}));
}

}  // namespace
}  // namespace dubsar
