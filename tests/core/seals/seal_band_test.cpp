// Bands of surfaces that are known, laid flat: lengths, reliefs and distortion that geometry says.

#include "core/seals/seal_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

/// A surface of columns x rows places.
TriMesh mesh_of(int columns, int rows, const std::function<glm::dvec3(double, double)>& place) {
  TriMesh mesh;
  mesh.frame.input_voxel.mm = glm::dvec3(1.0);
  mesh.frame.input_voxel.provenance = "test";
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.positions.emplace_back(place(i * 1.0 / columns, j * 1.0 / rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto at = [&](int a, int b) { return static_cast<std::uint32_t>(b * (columns + 1) + a); };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

constexpr double kRoundMm = 20.0, kBumpMm = 0.4, kBumpWide = 0.8;
struct BumpPlace {
  double along, up;
};
constexpr BumpPlace kBumps[] = {{-12.0, 3.0}, {0.0, -4.0}, {9.0, 5.0}};

double bumps(double along, double up) {
  double out = 0.0;
  for (const BumpPlace& b : kBumps)
    out +=
        kBumpMm * std::exp(-0.5 * (std::pow((along - b.along) / kBumpWide, 2) + std::pow((up - b.up) / kBumpWide, 2)));
  return out;
}

TEST(SealBand, OfACylinderIsAsLongAsItsArcAndShowsWhereReliefIs) {
  const auto place = [](double along, double up, double height) {
    const double a = along / kRoundMm;
    return glm::dvec3((kRoundMm + height) * std::sin(a), up, (kRoundMm + height) * std::cos(a));
  };
  const TriMesh mesh = mesh_of(300, 160, [&](double s, double t) {
    const double along = 60.0 * (s - 0.5), up = 32.0 * (t - 0.5);
    return place(along, up, bumps(along, up));
  });
  const auto band = unroll(mesh, {place(-18.0, 0.0, 0.0), place(18.0, 0.0, 0.0), 17.0});
  ASSERT_TRUE(band) << band.error().message;
  EXPECT_LT(band->distortion.length_95, 0.005);
  EXPECT_LT(band->distortion.angle_95_deg, 0.3);
  EXPECT_NEAR(band->relief.width * band->relief.step_mm, 36.0, 1.1);  // the middle line ends with a whole millimetre
  for (const BumpPlace& b : kBumps) {
    double highest = -1.0;
    glm::dvec2 at(0.0);
    for (int y = 0; y < band->relief.height; ++y)
      for (int x = 0; x < band->relief.width; ++x) {
        const glm::dvec2 p = band->relief.step_mm * glm::dvec2(x, y);
        if (std::hypot(p.x - 18.0 - b.along, p.y - 9.0 - b.up) > 2.0) continue;
        if (const double mm = static_cast<double>(band->relief.at(x, y)); mm > highest) highest = mm, at = p;
      }
    EXPECT_NEAR(at.x, 18.0 + b.along, 0.2);
    EXPECT_NEAR(at.y, 9.0 + b.up, 0.2);
    EXPECT_NEAR(highest, kBumpMm, 0.08);
    const auto surface = band->surface_mm(at);
    ASSERT_TRUE(surface);
    EXPECT_LT(glm::distance(*surface, place(b.along, b.up, 0.0)), 0.25);
  }
}

// The angles of triangles on a sphere sum to more than two right ones: Gauss's curvature over the band's height bounds
// what any flat map can do. Lengths along circles of latitude at +-h/2 shrink by 1 - cos(h / 2R).
TEST(SealBand, OfASphereIsDistortedByWhatItsCurvatureAsks) {
  constexpr double kSphereMm = 40.0;
  const TriMesh mesh = mesh_of(240, 160, [](double s, double t) {
    const double a = 1.6 * (s - 0.5), b = 0.9 * (t - 0.5);
    return kSphereMm * glm::dvec3(std::sin(a) * std::cos(b), std::sin(b), std::cos(a) * std::cos(b));
  });
  const auto on = [](double along) {
    return kSphereMm * glm::dvec3(std::sin(along / kSphereMm), 0.0, std::cos(along / kSphereMm));
  };
  const auto band = unroll(mesh, {on(-20.0), on(20.0), 16.0});
  ASSERT_TRUE(band) << band.error().message;
  const double shrinks = 1.0 - std::cos(8.0 / kSphereMm);  // 2 %
  EXPECT_LT(band->distortion.length_95, shrinks);          // of a map that keeps the middle line
  EXPECT_GT(band->distortion.length_95, 0.2 * shrinks);
}

TEST(SealBand, SaysWhatIsNoBand) {
  const TriMesh mesh = mesh_of(60, 60, [](double s, double t) { return glm::dvec3(30 * s, 30 * t, 0.0); });
  EXPECT_FALSE(unroll(mesh, {{1, 1, 0}, {1, 1, 0}, 17.0}));
  EXPECT_FALSE(unroll(mesh, {{1, 1, 0}, {20, 1, 0}, 0.0}));
  EXPECT_TRUE(unroll(mesh, {{3, 15, 0}, {27, 15, 0}, 10.0}));
}

}  // namespace
}  // namespace dubsar
