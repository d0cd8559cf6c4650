// The surface lies where it is although air and clay are not equally bright everywhere; even scans are left alone.

#include "core/filter/levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/base/system/parallel.h"
#include "tests/core/filter/filter_oracle.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

constexpr std::int64_t kEdge = 96;
constexpr double kBallMiddle = 47.5, kRadius = 37.0, kBlur = 0.7;
constexpr float kHalf = 0.5f;

struct Greys {
  double air, clay;
};
using GreysAt = std::function<Greys(const glm::dvec3&)>;

/// A ball of clay with a gap of four voxels of air around it and clay around that, blurred.
Volume<float> ball(const GreysAt& greys, double noise, bool wrapped) {
  oracle::Noise gauss(3);
  return oracle::make_volume({kEdge, kEdge, kEdge}, [&](auto x, auto y, auto z) {
    const glm::dvec3 p(x, y, z);
    const double out = glm::length(p - kBallMiddle) - kRadius;
    const auto within = [&](double d) { return 0.5 * std::erfc(d / (kBlur * std::sqrt(2.0))); };
    const double share = within(out) + (wrapped ? within(4.0 - out) : 0.0);
    const Greys g = greys(p);
    return g.air + share * (g.clay - g.air) + noise * gauss();
  });
}

/// Mean distance of the surface from the ball's, outwards, over a part of its directions.
double bias(const Volume<float>& volume, const std::function<bool(const glm::dvec3&)>& part) {
  const auto value = [&](const glm::dvec3& p) {
    const glm::dvec3 floor(std::floor(p.x), std::floor(p.y), std::floor(p.z)), t = p - floor;
    double sum = 0.0;
    for (int k = 0; k < 8; ++k)
      sum += (k & 1 ? t.x : 1 - t.x) * (k & 2 ? t.y : 1 - t.y) * (k & 4 ? t.z : 1 - t.z) *
             double(volume.at(std::int64_t(floor.x) + (k & 1), std::int64_t(floor.y) + (k >> 1 & 1),
                              std::int64_t(floor.z) + (k >> 2)));
    return sum;
  };
  double sum = 0.0, count = 0.0;
  for (int i = 0; i < 4000; ++i) {  // a spiral over the sphere
    const double z = 1.0 - (2.0 * i + 1.0) / 4000.0, angle = i * 2.399963229728653;
    const glm::dvec3 n(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
    if (!part(n)) continue;
    double least = 9.0;
    for (double at = -2.0; at < 2.0; at += 0.05) {
      const double a = value(kBallMiddle + (kRadius + at) * n), b = value(kBallMiddle + (kRadius + at + 0.05) * n);
      if (a < double(kHalf) || b >= double(kHalf)) continue;
      least = std::abs(at) < std::abs(least) ? at + 0.05 * (a - double(kHalf)) / (a - b) : least;
    }
    sum += std::clamp(least, -2.0, 2.0);
    count += 1.0;
  }
  return sum / count;
}

LocalLevels measure(const Volume<float>& volume) {
  VolumeSource source(volume);
  SilentProgress progress;
  return measure_levels(source, {kHalf, 0.0f, 1.0f, {}}, progress).value();
}
Volume<float> levelled(const Volume<float>& volume, const LocalLevels& levels) {
  VolumeSource source(volume);
  LevelledSource less(source, levels.shift);
  return testing::read_all(less).value();
}

const auto kDark = [](const glm::dvec3& n) { return n.y < -0.7; };
const auto kBright = [](const glm::dvec3& n) { return n.y > 0.7; };

TEST(Levels, ShadingAcrossTheObjectDoesNotMoveItsSurface) {
  // As scatter does: clay from .55 to 1, air from .2 to 0 across the scan.
  const GreysAt shaded = [](const glm::dvec3& p) { return Greys{0.2 - 0.2 * p.y / 95.0, 0.55 + 0.45 * p.y / 95.0}; };
  for (const bool wrapped : {false, true}) {
    const Volume<float> volume = ball(shaded, 0.05, wrapped);
    EXPECT_LT(bias(volume, kDark), -0.2) << "one threshold is as good";
    const LocalLevels levels = measure(volume);
    ASSERT_FALSE(levels.shift.empty());
    const Volume<float> even = levelled(volume, levels);
    EXPECT_NEAR(bias(even, kDark), 0.0, 0.05) << wrapped;
    EXPECT_NEAR(bias(even, kBright), 0.0, 0.05) << wrapped;
    EXPECT_LT(levels.least, -0.05);
    EXPECT_GT(levels.least, -0.15);
  }
}

TEST(Levels, EvenScansAreLeftAsTheyAre) {
  const GreysAt even = [](const glm::dvec3&) { return Greys{0.0, 1.0}; };
  for (const double noise : {0.0, 0.14})
    for (const bool wrapped : {false, true}) {
      const LocalLevels levels = measure(ball(even, noise, wrapped));
      EXPECT_TRUE(levels.shift.empty()) << noise << " " << wrapped << ": " << levels.least << " " << levels.most;
    }
  const Volume<float> air(Dims{20, 20, 20});
  EXPECT_TRUE(measure(air).shift.empty());
}

TEST(Levels, ScaleOffsetAndThreadsChangeNothing) {
  const GreysAt shaded = [](const glm::dvec3& p) { return Greys{0.2 - 0.2 * p.y / 95.0, 0.55 + 0.45 * p.y / 95.0}; };
  const Volume<float> volume = ball(shaded, 0.05, true);
  Volume<float> scaled(volume.dims);
  for (std::int64_t i = 0; i < volume.voxels.size(); ++i) scaled.voxels[i] = 8.0f * volume.voxels[i] - 2.0f;
  VolumeSource source(scaled);
  SilentProgress progress;
  set_thread_count(1);
  const LocalLevels one = measure(volume);
  set_thread_count(3);
  const LocalLevels three = measure(volume);
  const LocalLevels other = measure_levels(source, {2.0f, -2.0f, 6.0f, {}}, progress).value();
  set_thread_count(0);
  const Dims cells = one.shift.cells();
  for (std::int64_t z = 0; z < cells.z; ++z)
    for (std::int64_t y = 0; y < cells.y; ++y)
      for (std::int64_t x = 0; x < cells.x; ++x) {
        EXPECT_EQ(one.shift.at(x, y, z), three.shift.at(x, y, z));
        EXPECT_NEAR(8.0f * one.shift.at(x, y, z), other.shift.at(x, y, z), 1e-3f);
      }
}

TEST(Levels, CrumbsThatNoiseMakesOfFoamAreNoClay) {
  // The ball stands in foam of .3: at the ball's lower end half way is .65, and nowhere less than .5.
  const Volume<float> volume = ball(
      [](const glm::dvec3& p) {
        return Greys{p.z < 30.0 ? 0.3 : 0.0, 1.0};
      },
      0.14, false);
  const LocalLevels levels = measure(volume);
  ASSERT_FALSE(levels.shift.empty());
  EXPECT_GT(levels.least, -0.04);
  EXPECT_NEAR(levels.most, 0.15, 0.04);
}

}  // namespace
}  // namespace dubsar
