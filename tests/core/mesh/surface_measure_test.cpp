// Measures on surfaces whose truth is known: spheres, boxes, cylinders, written plates.

#include "core/mesh/surface_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <random>

namespace dubsar {
namespace {

constexpr double kPi = std::numbers::pi;

/// A grid of cells over (0..1)^2, each place from `at`; closed in u when `round`.
template <class At>
TriMesh grid_of_cells(int nu, int nv, bool round, const At& at) {
  TriMesh mesh;
  const int row = round ? nu : nu + 1;
  for (int v = 0; v <= nv; ++v)
    for (int u = 0; u < row; ++u)
      mesh.positions.emplace_back(at(static_cast<double>(u) / nu, static_cast<double>(v) / nv));
  const auto id = [&](int u, int v) { return static_cast<std::uint32_t>(v * row + (round ? u % nu : u)); };
  for (int v = 0; v < nv; ++v)
    for (int u = 0; u < nu; ++u) {
      mesh.triangles.push_back({id(u, v), id(u + 1, v), id(u + 1, v + 1)});
      mesh.triangles.push_back({id(u, v), id(u + 1, v + 1), id(u, v + 1)});
    }
  return mesh;
}

TriMesh sphere(double radius) {
  return grid_of_cells(240, 120, true, [&](double u, double v) {
    const double a = 2 * kPi * u, b = kPi * (v - 0.5);
    return radius * glm::dvec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
  });
}

SurfacePlace place(const TriMesh& mesh, const glm::dvec3& p) { return nearest_place(mesh, p).value(); }

TEST(SurfaceMeasure, WaysOnASphereAreThoseOfGreatCirclesWithinATenthOfAPercent) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  std::normal_distribution<> normal;
  TriMesh mesh = sphere(20.0 / 0.04);
  mesh.frame.input_voxel.mm = glm::dvec3(0.04);  // 20 mm
  for (int i = 0; i < 25; ++i) {
    const glm::dvec3 a = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const glm::dvec3 b = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    if (glm::dot(a, b) < -0.98) continue;  // all ways are as short
    const auto from = place(mesh, 20.0 * a), to = place(mesh, 20.0 * b);
    EXPECT_NEAR(glm::distance(from.at_mm, 20.0 * a), 0.0, 0.01);
    const auto path = section_between(mesh, from, to);
    ASSERT_FALSE(path.empty()) << "seed " << seed;
    const double truth = 20.0 * std::acos(glm::dot(a, b));
    EXPECT_NEAR(length_of(path), truth, 1e-3 * truth) << "seed " << seed;
    EXPECT_EQ(path.front(), from.at_mm);
    EXPECT_EQ(path.back(), to.at_mm);
  }
}

TEST(SurfaceMeasure, WaysGoRoundEdgesAndNotAcrossGaps) {
  // A sheet folded by a right angle: 10 mm up to the fold, 10 mm beyond it.
  const TriMesh folded = grid_of_cells(40, 40, false, [](double u, double v) {
    return u <= 0.5 ? glm::dvec3(20 * u, 20 * v, 0) : glm::dvec3(10, 20 * v, -20 * (u - 0.5));
  });
  const auto path = section_between(folded, place(folded, {4, 7, 0}), place(folded, {10, 7, -3}));
  EXPECT_NEAR(length_of(path), 6.0 + 3.0, 0.009);
  TriMesh two = grid_of_cells(10, 10, false, [](double u, double v) { return glm::dvec3(5 * u, 5 * v, 0); });
  const TriMesh other =
      grid_of_cells(10, 10, false, [](double u, double v) { return glm::dvec3(8 + 5 * u, 5 * v, 0); });
  const auto base = static_cast<std::uint32_t>(two.positions.size());
  two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles) two.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  EXPECT_TRUE(section_between(two, place(two, {1, 1, 0}), place(two, {10, 1, 0})).empty());
  EXPECT_NEAR(length_of(section_between(two, place(two, {1, 1, 0}), place(two, {4, 3, 0}))), std::hypot(3, 2), 1e-6);
}

TEST(SurfaceMeasure, AProfileKnowsItsDeepestPlace) {
  const TriMesh plate = grid_of_cells(400, 40, false, [](double u, double v) {
    const double x = 20 * u;  // a groove of 45 degrees, 2 mm deep, in the middle
    return glm::dvec3(x, 4 * v, -std::max(0.0, 2.0 - std::abs(x - 10)));
  });
  const auto path = section_between(plate, place(plate, {3, 2, 0}), place(plate, {17, 2, 0}));
  EXPECT_NEAR(length_of(path), 10.0 + 4.0 * std::sqrt(2.0), 0.015);
  EXPECT_NEAR(deepest_below_chord(path, {0, 0, 1}), 2.0, 0.002);
  EXPECT_EQ(deepest_below_chord({}, {0, 0, 1}), 0.0);
}

TEST(SurfaceMeasure, Angles) {
  EXPECT_NEAR(angle_between_deg({1, 0, 0}, {0, 0, 0}, {0, 2, 0}), 90.0, 1e-12);
  EXPECT_NEAR(angle_between_deg({1, 0, 0}, {0, 0, 0}, {1, 1e-6, 0}), 1e-6 * 180 / kPi, 1e-12) << "small ones too";
  EXPECT_NEAR(angle_between_deg({2, 1, 1}, {1, 1, 1}, {0.5, 1 + std::sqrt(0.75), 1}), 120.0, 1e-9);
  EXPECT_EQ(angle_between_deg({1, 1, 1}, {1, 1, 1}, {0, 0, 0}), 0.0);
}

TEST(SurfaceMeasure, WedgesOnABentAndUnevenSideAreAsDeepAsTheyWereMadeWithinThreePercent) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  struct Wedge {
    glm::dvec2 at;
    double depth, half_width;
    double made = 0.0;  ///< as deep as the vertices of the plate go: tips lie between them
  };
  std::vector<Wedge> wedges;
  while (wedges.size() < 60) {  // a third of the plate is written on, as dense text is
    const Wedge wedge{{real(4, 36), real(4, 36)}, real(0.4, 1.0), real(0.6, 1.0)};
    if (std::none_of(wedges.begin(), wedges.end(), [&](const Wedge& w) {
          return glm::distance(w.at, wedge.at) < w.half_width + wedge.half_width + 0.6;
        }))
      wedges.push_back(wedge);
  }
  const auto side = [](double x, double y) { return -((x - 20) * (x - 20) + (y - 20) * (y - 20)) / (2 * 60.0); };
  std::normal_distribution<> noise(0.0, 0.012);
  const TriMesh plate = grid_of_cells(500, 500, false, [&](double u, double v) {
    const double x = 40 * u, y = 40 * v;
    double hollow = 0.0;
    for (Wedge& w : wedges) {
      const double here = w.depth * (1.0 - glm::distance(w.at, glm::dvec2(x, y)) / w.half_width);
      w.made = std::max(w.made, here);
      hollow = std::max(hollow, here);
    }
    return glm::dvec3(x, y, side(x, y) - hollow + noise(random));
  });
  std::vector<double> ratio, error;
  for (const Wedge& w : wedges) {
    // Asked for on the wall, not at the bottom.
    const glm::dvec2 at = w.at + glm::dvec2(0.25 * w.half_width, 0.1 * w.half_width);
    const auto found =
        impression_depth(plate, place(plate, {at.x, at.y, side(at.x, at.y) - 0.6 * w.depth}), {kDepthRadiusMm});
    ASSERT_TRUE(found) << found.error().message;
    const double slope = 1.0 / std::sqrt(1.0 + glm::dot(w.at - 20.0, w.at - 20.0) / 3600.0);  // along the normal
    ratio.push_back(found->depth_mm / (w.made * slope));
    error.push_back(std::abs(ratio.back() - 1.0));
    EXPECT_NEAR(glm::distance(glm::dvec2(found->bottom_mm), w.at), 0.0, 0.25) << "seed " << seed;
    EXPECT_NEAR(glm::distance(found->rim_mm, found->bottom_mm), found->depth_mm, 1e-9);
  }
  std::nth_element(error.begin(), error.begin() + 30, error.end());
  std::nth_element(ratio.begin(), ratio.begin() + 30, ratio.end());
  EXPECT_LT(error[30], 0.03) << "seed " << seed;
  EXPECT_NEAR(ratio[30], 1.0, 0.03) << "seed " << seed;
}

TEST(SurfaceMeasure, WhatABlurFilledOfABottomIsGivenBackWhereTheBlurIsKnown) {
  constexpr int kCells = 160;
  constexpr double kSide = 8.0, kStep = kSide / kCells, kSlope = 0.8, kRounding = 0.1, kDepth = 0.5, kBlur = 0.12;
  std::vector<double> height, blurred;
  for (int v = 0; v <= kCells; ++v)
    for (int u = 0; u <= kCells; ++u)
      height.push_back(
          -std::max(0.0, kDepth - kSlope * (std::hypot(kStep * u - 4, kStep * v - 4, kRounding) - kRounding)));
  for (int v = 0; v <= kCells; ++v)
    for (int u = 0; u <= kCells; ++u) {
      double sum = 0.0, all = 0.0;
      for (int y = std::max(0, v - 10); y <= std::min(kCells, v + 10); ++y)
        for (int x = std::max(0, u - 10); x <= std::min(kCells, u + 10); ++x) {
          const double weight =
              std::exp(-0.5 * kStep * kStep * ((x - u) * (x - u) + (y - v) * (y - v)) / (kBlur * kBlur));
          sum += weight * height[static_cast<std::size_t>(y * (kCells + 1) + x)];
          all += weight;
        }
      blurred.push_back(sum / all);
    }
  const TriMesh plate = grid_of_cells(kCells, kCells, false, [&](double u, double v) {
    const auto at = static_cast<std::size_t>(std::lround(v * kCells) * (kCells + 1) + std::lround(u * kCells));
    return glm::dvec3(kSide * u, kSide * v, blurred[at]);
  });
  const SurfacePlace wall = place(plate, {4.2, 4.1, -0.3});
  const auto unknown = impression_depth(plate, wall),
             known = impression_depth(plate, wall, {.blur_mm2 = kBlur * kBlur});
  ASSERT_TRUE(unknown && known);
  EXPECT_LT(unknown->depth_mm, 0.92 * kDepth);
  EXPECT_EQ(unknown->filled_mm, 0.0);
  EXPECT_NEAR(known->depth_mm, kDepth, 0.04 * kDepth);
  EXPECT_NEAR(known->depth_mm - known->filled_mm, unknown->depth_mm, 1e-12);
  EXPECT_GT(known->uncertainty_mm, unknown->uncertainty_mm);
  EXPECT_LT(std::abs(known->depth_mm - kDepth), 2 * known->uncertainty_mm);
}

TEST(SurfaceMeasure, ClayThatWasPushedUpRoundAWedgeDoesNotCountAsGround) {
  // Lips of a twentieth of the depth, falling off over half of the wedge's width.
  const TriMesh plate = grid_of_cells(320, 320, false, [](double u, double v) {
    const double x = 16 * u, y = 16 * v;
    const double r = std::hypot(std::remainder(x - 8, 2.6), std::remainder(y - 8, 2.6));  // dense: one each 2.6 mm
    const double beyond = std::max(0.0, r - 0.8);
    const double lip = r > 0.8 && beyond < 0.4 ? 0.04 * (1 - beyond / 0.4) * (1 - beyond / 0.4) : 0.0;
    return glm::dvec3(x, y, r < 0.8 ? -0.8 + 1.05 * r : lip);
  });
  const auto found = impression_depth(plate, place(plate, {8.2, 8.1, -0.5}));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->depth_mm, 0.8, 0.01);
}

TEST(SurfaceMeasure, NorDoesItOnASurfaceAsRoughAsThoseOfScans) {
  // Impressions as dense as in text: lips of 6 % of the depth cover most of what is between them, and noise hides them.
  std::mt19937 random(8806);
  std::normal_distribution<double> noise(0.0, 0.012);
  const TriMesh plate = grid_of_cells(400, 400, false, [&](double u, double v) {
    const double x = 20 * u, y = 20 * v;
    const double r = std::hypot(std::remainder(x - 10, 1.6), std::remainder(y - 10, 1.6));
    const double beyond = std::max(0.0, r - 0.5) / 0.25;
    const double lip = r > 0.5 && beyond < 1.0 ? 0.03 * (1 - beyond) * (1 - beyond) : 0.0;
    return glm::dvec3(x, y, (r < 0.5 ? -0.5 + 1.06 * r : lip) + noise(random));
  });
  std::vector<double> told;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      const auto found = impression_depth(plate, place(plate, {10 + 1.6 * i + 0.05, 10 + 1.6 * j, -0.4}));
      ASSERT_TRUE(found);
      told.push_back(found->depth_mm);
    }
  std::sort(told.begin(), told.end());
  EXPECT_NEAR(told[12], 0.5, 0.005);
}

TEST(SurfaceMeasure, WhatCannotBeMeasuredIsRefusedInASentence) {
  const TriMesh plate = grid_of_cells(10, 10, false, [](double u, double v) { return glm::dvec3(5 * u, 5 * v, 0); });
  EXPECT_EQ(nearest_place(TriMesh(), {0, 0, 0}).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(impression_depth(plate, place(plate, {2, 2, 0}), {0.0}).error().kind, ErrorKind::kUsage);
  const auto few = impression_depth(plate, place(plate, {2, 2, 0}), {0.6});
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().message.find("expected at least 30"), std::string::npos) << few.error().message;
  EXPECT_NEAR(impression_depth(plate, place(plate, {2, 2, 0}), {3.0})->depth_mm, 0.0, 1e-6) << "level is level";
}

}  // namespace
}  // namespace dubsar
