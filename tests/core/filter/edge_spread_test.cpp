#include "core/filter/edge_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "core/base/system/parallel.h"
#include "tests/core/filter/filter_oracle.h"

namespace dubsar {
namespace {

/// Copies of an edge and how heavy they are, voxels across the axis z: what a scanner's turn about it makes of an edge.
using Copies = std::vector<std::pair<double, double>>;

/// A turned brick of half sizes 30, 26 and 34 times `scale` in 96^3 times as many voxels, blurred by a Gauss: a product
/// of error functions. Faces appear as `copies` of themselves, moved by as much as they stand across z.
Volume<float> brick(double deviation, double noise, std::uint64_t seed, double scale = 1.0,
                    const Copies& copies = {{0.0, 1.0}}) {
  const glm::dvec3 a = glm::normalize(glm::dvec3(0.82, 0.31, -0.21)),
                   b = glm::normalize(glm::cross(a, glm::dvec3(0.1, 0.2, 1.0))), c = glm::cross(a, b),
                   middle = scale * glm::dvec3(48.3, 47.2, 46.9);
  const auto across = [&](double half, const glm::dvec3& normal, const glm::dvec3& p) {
    const double s = std::sqrt(2.0) * deviation, at = glm::dot(p, normal);
    double sum = 0.0;
    for (const auto& [move, weight] : copies) {
      const double by = move * std::hypot(normal.x, normal.y);
      sum += 0.5 * weight * (std::erf((half + by - at) / s) + std::erf((half + by + at) / s));
    }
    return sum;
  };
  oracle::Noise random(seed);
  const auto side = static_cast<std::int64_t>(96 * scale);
  return oracle::make_volume({side, side, side}, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    const glm::dvec3 p = glm::dvec3(x, y, z) - middle;
    return 3.0 + 2.0 * (across(30.0 * scale, a, p) * across(26.0 * scale, b, p) * across(34.0 * scale, c, p) +
                        noise * random());
  });
}

std::optional<EdgeSpread> measured(const Volume<float>& volume) {
  VolumeSource source(volume);
  SilentProgress progress;
  return measure_edge_spread(source, 3.0, 5.0, progress).value();
}

TEST(EdgeSpread, IsTheVarianceOfAGaussThroughTheNoiseOf17Decibels) {
  for (const double deviation : {0.4, 0.6, 0.8, 1.0})
    for (const double noise : {0.0, 0.141}) {
      const auto spread = measured(brick(deviation, noise, 71));
      ASSERT_TRUE(spread.has_value()) << deviation;
      EXPECT_NEAR(spread->variance, deviation * deviation, 0.06 * deviation * deviation + 0.04)
          << deviation << " with noise " << noise;
      EXPECT_LT(spread->uncertainty, 0.1);
    }
}

TEST(EdgeSpread, OfASmallScanIsMeasuredInMoreOfItsSlices) {
  for (const double deviation : {0.5, 0.8})
    for (const double scale : {0.45, 0.6}) {
      const auto spread = measured(brick(deviation, 0.141, 71, scale));
      ASSERT_TRUE(spread.has_value()) << deviation << " at " << scale;
      EXPECT_NEAR(spread->variance, deviation * deviation, 0.1 * deviation * deviation + 0.06)
          << deviation << " at " << scale;
    }
}

TEST(EdgeSpread, IsTheSameForAnyNumberOfThreads) {
  const Volume<float> volume = brick(0.7, 0.1, 5);
  const auto first = measured(volume);
  set_thread_count(1);
  const auto second = measured(volume);
  set_thread_count(0);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->variance, second->variance);
  EXPECT_EQ(first->places, second->places);
}

TEST(EdgeSpread, AnAxisThatWasOffInAFullTurnDoublesEdgesAcrossItAndIsTold) {
  for (const double off : {1.2, 1.6})
    for (const double noise : {0.0, 0.1}) {
      const auto spread = measured(brick(0.7, noise, 72, 1.0, {{-off, 0.5}, {off, 0.5}}));
      ASSERT_TRUE(spread.has_value()) << off;
      ASSERT_TRUE(spread->doubled.has_value()) << off << " with noise " << noise;
      EXPECT_EQ(spread->doubled->axis, 2);
      EXPECT_NEAR(spread->doubled->apart, 2.0 * off, 0.6) << off << " with noise " << noise;
    }
}

// Weights of windows of the ramp as a reconstruction on this grid has them, and of one that cuts at half of it.
TEST(EdgeSpread, NoBlurAcrossAnAxisIsADoubleEdge) {
  for (const double noise : {0.0, 0.1}) {
    for (const Copies& copies : {Copies{{-1.0, 0.25}, {0.0, 0.5}, {1.0, 0.25}}, Copies{{-0.5, 0.5}, {0.5, 0.5}},
                                 Copies{{-2.0, 0.25}, {0.0, 0.5}, {2.0, 0.25}}, Copies{{0.0, 1.0}}}) {
      const auto spread = measured(brick(0.7, noise, 73, 1.0, copies));
      ASSERT_TRUE(spread.has_value());
      EXPECT_FALSE(spread->doubled.has_value()) << copies.front().first << " with noise " << noise;
    }
  }
}

TEST(EdgeSpread, WhatIsNotFlatSaysNothing) {
  const Volume<float> balls = oracle::make_volume({64, 64, 64}, [](std::int64_t x, std::int64_t y, std::int64_t z) {
    const double u = static_cast<double>(x % 16) - 7.5, v = static_cast<double>(y % 16) - 7.5,
                 w = static_cast<double>(z % 16) - 7.5;
    return 3.0 + 1.0 * (1.0 + std::erf((6.0 - std::sqrt(u * u + v * v + w * w)) / 0.85));
  });
  EXPECT_FALSE(measured(balls).has_value());
  EXPECT_FALSE(measured(Volume<float>(Dims{64, 64, 64})).has_value());
}

TEST(EdgeSpread, WhatDoesNotStandOutOfItsUncertaintySaysNothing) {
  // A mask: whole voxels of one value or the other, as no scanner sees them, through noise.
  EXPECT_FALSE(measured(brick(1e-3, 0.141, 71)).has_value());
  EXPECT_TRUE(measured(brick(0.3, 0.141, 71)).has_value()) << "the sharpest that a scan can be";
}

}  // namespace
}  // namespace dubsar
