#include "core/contact/recentre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/core/contact/counted_source.h"

namespace dubsar {
namespace {

constexpr std::int64_t kEdge = 128;
constexpr float kPatch = 60.0f;  ///< height of the patch

/// Clay of density 1 with noise, and a film: as dark as `depth` says in the middle of a Gauss across z = `film(x, y)`.
template <class Film>
Volume<float> clay(float depth, const Film& film, unsigned seed, float deviation = 0.14f) {
  Volume<float> volume(Dims{kEdge, kEdge, kEdge});
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0f, deviation);  // 17 dB
  for (std::int64_t z = 0, i = 0; z < kEdge; ++z)
    for (std::int64_t y = 0; y < kEdge; ++y)
      for (std::int64_t x = 0; x < kEdge; ++x, ++i) {
        const float off = (static_cast<float>(z) - film(static_cast<float>(x), static_cast<float>(y))) / 0.75f;
        volume.voxels[static_cast<std::size_t>(i)] = 1.0f - depth * std::exp(-0.5f * off * off) + noise(random);
      }
  return volume;
}

std::vector<PatchPoint> flat_patch() {
  std::vector<PatchPoint> samples;
  for (float y = 16.0f; y < 112.0f; y += 0.7f)
    for (float x = 16.0f; x < 112.0f; x += 0.7f) samples.push_back({{x, y, kPatch}, {0.0f, 0.0f, 1.0f}});
  return samples;
}

struct Moved {
  float told = 0.0f;
  std::vector<PatchPoint> samples;
};
BitVolume signs_of(const Volume<float>& volume) {
  BitVolume inside(volume.dims);
  for (std::int64_t z = 0, i = 0; z < kEdge; ++z)
    for (std::int64_t y = 0; y < kEdge; ++y)
      for (std::int64_t x = 0; x < kEdge; ++x, ++i)
        inside.set(x, y, z, volume.voxels[static_cast<std::size_t>(i)] > 0.0f);
  return inside;
}
Moved moved(const Volume<float>& volume, decltype(recentre_samples)* recentre = recentre_samples_at_half,
            std::vector<PatchPoint> samples = flat_patch()) {
  const BitVolume inside = signs_of(volume);
  VolumeSource source(volume);
  SilentProgress progress;
  Moved out{0.0f, std::move(samples)};
  out.told = recentre(out.samples, inside, source, progress, {}).value().longest;
  return out;
}

/// Away from the rim, where half of what is around lies outside.
bool amid(const PatchPoint& s) {
  return std::max(std::abs(s.position.x - 64.0f), std::abs(s.position.y - 64.0f)) < 24.0f;
}

TEST(RecentreSamples, FollowsAFilmFarFromThePatch) {
  const auto tilted = [](float x, float y) { return kPatch - 11.0f + 0.06f * (x - 64.0f) - 0.04f * (y - 64.0f); };
  const Moved found = moved(clay(0.13f, tilted, 41));  // the dip of a fifth of a voxel of air
  for (const PatchPoint& s : found.samples)
    if (amid(s)) {
      ASSERT_NEAR(s.position.z, tilted(s.position.x, s.position.y), 1.5f) << s.position.x << " " << s.position.y;
    }
  EXPECT_NEAR(found.told, 13.0f, 4.0f);
}

TEST(RecentreSamples, FollowsAFilmBeyondItsReach) {
  // A corner of the tablet that the patch cuts off: 24 steps from it can be seen, the film is 34 from its middle.
  const auto dome = [](float x, float y) {
    const float u = (x - 64.0f) / 50.0f, v = (y - 64.0f) / 50.0f;
    return kPatch + 34.0f * std::max(1.0f - u * u - v * v, 0.0f);
  };
  const Moved found = moved(clay(0.3f, dome, 59));  // the dip of half a voxel of air
  double squares = 0.0, count = 0.0;
  for (const PatchPoint& s : found.samples) {
    if (!amid(s)) continue;
    const auto off = static_cast<double>(s.position.z - dome(s.position.x, s.position.y));
    squares += off * off;
    count += 1.0;
  }
  EXPECT_LT(std::sqrt(squares / count), 3.0);
  EXPECT_NEAR(found.told, 34.0f, 5.0f);
}

TEST(RecentreSamples, OnAGridThatIsHalvedAlreadyItLooksTwelveStepsFar) {
  const auto tilted = [](float x, float y) { return kPatch + 7.0f + 0.05f * (x - 64.0f) - 0.03f * (y - 64.0f); };
  const Moved found = moved(clay(0.13f, tilted, 53, 0.06f), recentre_samples);  // the noise that 2:1 leaves of 17 dB
  for (const PatchPoint& s : found.samples)
    if (amid(s)) {
      ASSERT_NEAR(s.position.z, tilted(s.position.x, s.position.y), 1.5f) << s.position.x << " " << s.position.y;
    }
  EXPECT_NEAR(found.told, 10.8f, 2.0f) << "in a corner";
}

TEST(RecentreSamples, FollowsASlopeToTheRim) {
  const auto tilted = [](float x, float y) { return kPatch + 0.25f * (x - 64.0f) + 0.05f * (y - 64.0f); };
  double sum = 0.0, squares = 0.0;
  const Moved found = moved(clay(0.13f, tilted, 47));
  for (const PatchPoint& s : found.samples) {
    const auto off = static_cast<double>(s.position.z - tilted(s.position.x, s.position.y));
    sum += off;
    squares += off * off;
    ASSERT_LT(std::abs(off), 2.2) << s.position.x << " " << s.position.y;
  }
  const auto count = static_cast<double>(found.samples.size());
  EXPECT_LT(std::abs(sum / count), 1.1);
  EXPECT_LT(std::sqrt(squares / count), 1.3);
}

TEST(RecentreSamples, StaysOnTheGroundWhereWedgesGoDown) {
  const auto ground = kPatch + 8.0f;
  const auto written = [&](float x, float y) {  // a third of the area: round pits, 7 deep, 14 wide, 21 apart
    const float u = std::fmod(x, 21.0f) - 10.0f, v = std::fmod(y, 21.0f) - 10.0f;
    return ground - std::max(0.0f, 7.0f - std::sqrt(u * u + v * v));
  };
  for (const PatchPoint& s : moved(clay(0.3f, written, 42)).samples)
    if (amid(s)) {
      ASSERT_NEAR(s.position.z, ground, 1.5f) << s.position.x << " " << s.position.y;
    }
}

TEST(RecentreSamples, GoesToTheMiddleOfAGapOfAir) {
  constexpr std::int64_t kLow = 62, kHigh = 76;  // all that is seen of where the two touch
  Volume<float> volume = clay(
      0.0f, [](float, float) { return 0.0f; }, 44);
  for (std::int64_t z = kLow; z < kHigh; ++z)
    for (std::int64_t y = 4; y < 124; ++y)
      for (std::int64_t x = 30; x < 98; ++x)
        volume.voxels[static_cast<std::size_t>((z * kEdge + y) * kEdge + x)] = -1.0f;
  constexpr double kMiddle = 0.5 * static_cast<double>(kLow + kHigh - 1);
  double sum = 0.0, count = 0.0;
  for (const PatchPoint& s : moved(volume).samples) {
    if (!amid(s)) continue;
    sum += static_cast<double>(s.position.z);
    count += 1.0;
  }
  EXPECT_NEAR(sum / count, kMiddle, 2.5);
}

TEST(RecentreSamples, LeavesSamplesOnTheWayFromARim) {
  const auto film = [](float, float) { return kPatch + 11.0f; };
  std::vector<PatchPoint> samples = flat_patch();
  for (PatchPoint& s : samples) s.at_rim = s.position.x > 70.0f && s.position.x < 71.0f;
  const std::size_t before = samples.size();
  const Moved found = moved(clay(0.3f, film, 45), recentre_samples_at_half, std::move(samples));
  ASSERT_GT(found.samples.size(), before);
  float lowest = 1e9f, farthest = 0.0f;
  for (std::size_t i = before; i < found.samples.size(); ++i) {
    const PatchPoint& s = found.samples[i];
    EXPECT_TRUE(s.at_rim);
    lowest = std::min(lowest, s.position.z);
    farthest = std::max(farthest, s.position.z);
  }
  EXPECT_FLOAT_EQ(lowest, kPatch) << "where the rim is";
  EXPECT_GT(farthest, kPatch + 7.0f) << "and no gap of more than four steps on the way";
}

TEST(RecentreSamples, StaysWhereNothingShows) {
  const Moved found = moved(clay(
      0.0f, [](float, float) { return 0.0f; }, 43));
  EXPECT_LT(found.told, 0.5f);
}

TEST(RecentreSamples, LooksForNoClayBeyondTheEndOfTheGrid) {
  constexpr float kTop = 124.0f;  // fewer steps below the end than the air that is looked through
  Volume<float> volume = clay(
      0.0f, [](float, float) { return kPatch; }, 61);
  for (std::int64_t z = std::int64_t{kEdge} - 3; z < kEdge; ++z)
    for (std::int64_t i = 0; i < kEdge * kEdge; ++i)
      volume.voxels[static_cast<std::size_t>(z * kEdge * kEdge + i)] = -1.0f;
  std::vector<PatchPoint> samples = flat_patch();
  for (PatchPoint& s : samples) s.position.z = kTop;
  const Moved found = moved(volume, recentre_samples, samples);
  for (std::size_t i = 0; i < samples.size(); ++i) ASSERT_NEAR(found.samples[i].position.z, kTop, 1.0f);
}

TEST(RecentreSamples, WhatIsKeptBetweenLooksIsWhatIsReadAnewForEach) {
  const auto tilted = [](float x, float) { return kPatch + 10.0f + 0.35f * (x - 64.0f); };
  const Volume<float> volume = clay(0.3f, tilted, 67, 0.06f);
  const BitVolume inside = signs_of(volume);
  SilentProgress progress;
  for (const auto recentre : {recentre_samples, recentre_samples_at_half}) {
    const bool half = recentre == recentre_samples_at_half;
    VolumeSource whole(volume);
    CountedSource kept_source(whole), anew_source(whole);
    std::vector<PatchPoint> kept = flat_patch();
    std::erase_if(kept,
                  [](const PatchPoint& s) {  // so few that none is farther from those that come far than a look asks
                    return std::max(std::abs(s.position.x - 64.0f), std::abs(s.position.y - 64.0f)) > 12.0f;
                  });
    std::vector<PatchPoint> anew = kept;
    ASSERT_TRUE(recentre(kept, inside, kept_source, progress, {}).has_value());
    int looks = 0;
    for (float longest = INFINITY; looks < 4 && longest > (half ? 6.0f : 3.0f); ++looks)
      longest =
          recentre(anew, inside, anew_source, progress, ContactRules().without(ContactRule::kLooks)).value().longest;
    ASSERT_GE(looks, 2);
    ASSERT_EQ(kept.size(), anew.size());
    for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(kept[i].position, anew[i].position) << i;
    if (half) {
      EXPECT_LE(kept_source.slices, kEdge) << "once, in all looks";
    }
    EXPECT_LT(kept_source.slices, anew_source.slices);
  }
}

}  // namespace
}  // namespace dubsar
