#include "core/contact/dents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/system/parallel.h"
#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

constexpr int kDentsEdge = 61;
constexpr float kLevel = 20.0f;

struct Pressed {
  float depth;       ///< of a cone, steps; < 0: a bump
  float radius;      ///< of the cone
  float strength;    ///< mean of the dips in it
  bool film = true;  ///< all of it
};

InterfaceMesh pressed_sheet(const Pressed& one) {
  const auto away = [](int x, int y) {
    return std::hypot(static_cast<float>(x) - 30.3f, static_cast<float>(y) - 29.8f);
  };
  InterfaceMesh mesh = sheet(kDentsEdge, [&](int x, int y) {
    return glm::vec3(static_cast<float>(x), static_cast<float>(y),
                     kLevel - one.depth * std::max(0.0f, 1.0f - away(x, y) / one.radius));
  });
  std::mt19937 bits(5);
  for (int y = 0; y < kDentsEdge; ++y)
    for (int x = 0; x < kDentsEdge; ++x) {
      const float chance = 0.3f * (static_cast<float>(bits() % 2000) / 1000.0f - 1.0f);
      mesh.strength[static_cast<std::size_t>(y) * kDentsEdge + static_cast<std::size_t>(x)] =
          (away(x, y) < one.radius ? one.strength : 1.9f) + chance;
    }
  return mesh;
}

/// How many vertices are doubtful; `outside`: of those farther than a step from the cone.
std::int64_t doubtful(const Pressed& one, std::int64_t& outside) {
  const InterfaceMesh mesh = pressed_sheet(one);
  const std::vector<bool> found =
      doubtful_dents(mesh, InterfaceRings(mesh, 0), {}, std::vector<bool>(mesh.added.size(), one.film));
  outside = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    outside += found[i] && std::hypot(mesh.added[i].x - 30.3f, mesh.added[i].y - 29.8f) > one.radius + 1.5f;
  return std::count(found.begin(), found.end(), true);
}

TEST(DoubtfulDents, ADentWithTheDipsOfClayIsDoubtfulAndOneWithThoseOfAFilmIsNot) {
  std::int64_t outside = 0;
  // More than 1.2 of 4 steps deep: .7 of the radius, 70 vertices at least.
  EXPECT_GT(doubtful({4.0f, 7.0f, PlainClay{}.strength}, outside), 60);
  EXPECT_EQ(outside, 0) << "the film around it is as sure as it was";
  EXPECT_EQ(doubtful({4.0f, 7.0f, 2.0f}, outside), 0);
}

TEST(DoubtfulDents, TheSameDipsProveALargeDentAndNotASmallOne) {
  // A mean of 1.8 is .7 above clay, which takes 2 * 2.5 / .7 squared, 51 vertices.
  std::int64_t outside = 0;
  EXPECT_EQ(doubtful({6.0f, 9.0f, 1.8f}, outside), 0);
  EXPECT_GT(doubtful({3.0f, 3.5f, 1.8f}, outside), 0);
}

TEST(DoubtfulDents, WhatIsFlatOrStandsOutOrIsNoFilmIsNoDent) {
  std::int64_t outside = 0;
  EXPECT_EQ(doubtful({0.8f, 7.0f, PlainClay{}.strength}, outside), 0) << "shallow";
  EXPECT_EQ(doubtful({-2.0f, 9.0f, PlainClay{}.strength}, outside), 0) << "a bump";
  EXPECT_EQ(doubtful({4.0f, 7.0f, PlainClay{}.strength, false}, outside), 0) << "nobody said it was a film";
}

TEST(DoubtfulDents, AreTheSameForAnyNumberOfThreads) {
  const InterfaceMesh mesh = pressed_sheet({4.0f, 9.0f, 1.5f});
  const InterfaceRings rings(mesh, 0);
  const std::vector<bool> film(mesh.added.size(), true);
  const std::vector<bool> all = doubtful_dents(mesh, rings, {}, film);
  set_thread_count(1);
  EXPECT_EQ(doubtful_dents(mesh, rings, {}, film), all);
  set_thread_count(0);
}

/// Means of n neighbours are as good as normal around that of a film or of clay: the ratio of the two densities there.
TEST(LikelihoodOfFilm, IsTheRatioOfTheDensitiesOfTheirMean) {
  const PlainClay plain{.strength = 0.8f, .deviation = 1.5f};
  const auto logarithm_of_normal = [](double x, double mean, double deviation) {
    return -0.5 * (x - mean) * (x - mean) / (deviation * deviation) - std::log(deviation * std::sqrt(2.0 * M_PI));
  };
  const double clay = static_cast<double>(plain.strength), film = clay + static_cast<double>(kFaintFilm);
  for (const std::size_t count : {std::size_t{1}, std::size_t{64}, std::size_t{5000}})
    for (const double mean : {-1.0, 0.8, 1.2, 3.0}) {
      const double n = static_cast<double>(count), of_mean = 1.5 / std::sqrt(n);
      const double ratio = logarithm_of_normal(mean, film, of_mean) - logarithm_of_normal(mean, clay, of_mean);
      EXPECT_NEAR(log_likelihood_of_film(n * mean, count, plain), ratio, 1e-6 * (1.0 + std::abs(ratio)))
          << count << " of " << mean;
    }
}

}  // namespace
}  // namespace dubsar
