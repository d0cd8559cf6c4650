#include "core/contact/clays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <random>

#include "core/contact/clay_sides.h"

namespace dubsar {
namespace {

constexpr std::int64_t kClayEdge = 72;
constexpr float kReach = 12.0f, kNoise = 0.4f;  ///< of single voxels, as behind a scan of 17 dB
constexpr float kPatchHeight = 35.5f;           ///< height of the patch

/// Clay everywhere, and a flat patch across it.
struct ClayScene {
  BitVolume inside{Dims{kClayEdge, kClayEdge, kClayEdge}};
  Volume<float> scan{Dims{kClayEdge, kClayEdge, kClayEdge}};
  ContactBand band;
  BandDensity density;

  explicit ClayScene(const std::function<float(const glm::vec3&)>& clay, float plane = kPatchHeight,
                     float noise = kNoise)
      : band(make(clay, plane, noise)), density(read()) {}

 private:
  ContactBand make(const std::function<float(const glm::vec3&)>& clay, float plane, float noise) {
    std::mt19937 bits(7);
    const auto uniform = [&] { return (static_cast<double>(bits()) + 0.5) / 4294967296.0; };
    std::vector<PatchPoint> samples;
    for (int z = 0; z < kClayEdge; ++z)
      for (int y = 0; y < kClayEdge; ++y)
        for (int x = 0; x < kClayEdge; ++x) {
          inside.set(x, y, z, true);
          const double gauss = std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
          scan.at(x, y, z) = clay(glm::vec3(x, y, z)) + noise * static_cast<float>(gauss);
        }
    for (int y = 1; y + 1 < kClayEdge; ++y)
      for (int x = 1; x + 1 < kClayEdge; ++x) samples.push_back({{x, y, plane}, {0.0f, 0.0f, 1.0f}});
    SilentProgress progress;
    return ContactBand::make(inside, std::move(samples), kReach, progress).value();
  }
  BandDensity read() {
    VolumeSource source(scan);
    SilentProgress progress;
    return BandDensity::read(band, source, progress).value();
  }
};

/// Where the border really is: a bowl that reaches 5 steps into the tablet.
float border(const glm::vec3& p) {
  const float u = (p.x - 36.0f) / 14.0f, v = (p.y - 36.0f) / 14.0f;
  return kPatchHeight - 5.0f * std::exp(-(u * u + v * v));
}

constexpr float kPointSpread =
    1.0f / 12.0f;  ///< noise of these scenes is white: only the voxel's extent is in the blur

TEST(CompareClays, FindsBothDensities) {
  const ClayScene scene([](const glm::vec3& p) { return p.z < border(p) ? 1.0f : 1.25f; });
  const auto contrast = compare_clays(scene.band, scene.inside, scene.density, kPointSpread);
  ASSERT_TRUE(contrast.has_value());
  EXPECT_NEAR(contrast->tablet, 1.0f, 0.02f);
  EXPECT_NEAR(contrast->envelope, 1.25f, 0.02f);
  // (3/8)^3 of the variance is left by [1 2 1]/4 along three axes.
  EXPECT_NEAR(contrast->deviation, kNoise * std::pow(0.375f, 1.5f), 0.01f);
  EXPECT_NEAR(contrast->white_deviation, kNoise, 0.15f * kNoise);
}

TEST(CompareClays, OneClayIsNotTwo) {
  const ClayScene same([](const glm::vec3&) { return 1.0f; });
  EXPECT_FALSE(compare_clays(same.band, same.inside, same.density, kPointSpread).has_value());
  // A scan that is darker in its middle, as beam hardening leaves it.
  const ClayScene slope([](const glm::vec3& p) { return 1.0f + 0.02f * (p.z - kPatchHeight); });
  EXPECT_FALSE(compare_clays(slope.band, slope.inside, slope.density, kPointSpread).has_value());
  // A film of air is no other clay.
  const ClayScene film([](const glm::vec3& p) { return std::abs(p.z - kPatchHeight) < 0.6f ? 0.6f : 1.0f; });
  EXPECT_FALSE(compare_clays(film.band, film.inside, film.density, kPointSpread).has_value());
}

TEST(CompareClays, TwoClaysAreToldApartWhereverTheyLieOnTheGrid) {
  for (const float plane : {29.5f, 35.5f, 41.5f, 45.5f, 47.5f, 49.5f, 53.5f}) {
    const ClayScene scene([&](const glm::vec3& p) { return p.z < plane ? 1.0f : 1.25f; }, plane);
    const auto contrast = compare_clays(scene.band, scene.inside, scene.density, kPointSpread);
    ASSERT_TRUE(contrast.has_value()) << plane;
    EXPECT_NEAR(contrast->step(), 0.25f, 0.01f) << plane;
  }
}

TEST(DivideClay, WithoutNoiseVotesAndCostsAreFinite) {
  const ClayScene scene([](const glm::vec3& p) { return p.z < border(p) ? 1.0f : 1.25f; }, kPatchHeight, 0.0f);
  const auto contrast = compare_clays(scene.band, scene.inside, scene.density, kPointSpread);
  ASSERT_TRUE(contrast.has_value());
  SilentProgress progress;
  const std::vector<float> votes = clay_votes(scene.band, scene.inside, scene.density, *contrast);
  const Dips dips = find_dips(scene.band, scene.inside, scene.density, progress).value();
  const auto side = ClayDivision({scene.band, dips, {}, votes, {}}).sides(progress).value();
  for (std::uint32_t n = 0; n < side.size(); ++n) {
    ASSERT_LT(std::abs(votes[n]), 1e5f);
    ASSERT_LT(std::abs(dips.strength[n]), 1e5f);
    const glm::vec3 p(scene.band.point(n));
    if (std::abs(p.z - border(p)) < 1.0f) continue;
    ASSERT_EQ(side[n] == ClaySide::kTablet, p.z < border(p)) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(DivideClay, FollowsTheBorderOfTwoClaysAwayFromThePatch) {
  const ClayScene scene([](const glm::vec3& p) { return p.z < border(p) ? 1.0f : 1.25f; });
  const auto contrast = compare_clays(scene.band, scene.inside, scene.density, kPointSpread);
  ASSERT_TRUE(contrast.has_value());
  SilentProgress progress;
  const Dips dips = find_dips(scene.band, scene.inside, scene.density, progress).value();
  const auto wrong = [&](const std::vector<float>& votes) {
    const auto side = ClayDivision({scene.band, dips, {}, votes, {}}).sides(progress).value();
    std::int64_t count = 0;
    for (std::uint32_t n = 0; n < side.size(); ++n) {
      const glm::vec3 p(scene.band.point(n));
      if (glm::length(glm::vec2(p.x - 36.0f, p.y - 36.0f)) > 10.0f || std::abs(p.z - border(p)) < 1.0f) continue;
      count += (side[n] == ClaySide::kTablet) != (p.z < border(p));
    }
    return count;
  };
  const std::int64_t without = wrong({});
  EXPECT_GT(without, 150) << "the patch alone is as good";
  EXPECT_LT(wrong(clay_votes(scene.band, scene.inside, scene.density, *contrast)), without / 5);
}

}  // namespace
}  // namespace dubsar
