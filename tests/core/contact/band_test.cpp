#include "core/contact/band.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/contact/dips.h"
#include "tests/core/contact/counted_source.h"

namespace dubsar {
namespace {

constexpr int kEdge = 40;
constexpr float kPlane = 19.5f;

ContactBand flat_band(float reach, float plane = kPlane) {
  BitVolume inside(Dims{kEdge, kEdge, kEdge});
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) inside.set(x, y, z, true);
  std::vector<PatchPoint> samples;
  for (int y = 14; y < 26; ++y)
    for (int x = 14; x < 26; ++x) samples.push_back({{x, y, plane}, {0.0f, 0.0f, 1.0f}});
  SilentProgress progress;
  return ContactBand::make(inside, std::move(samples), reach, progress).value();
}

TEST(ContactBand, TrimmedReachesLessIntoTheEnvelopeAlone) {
  const ContactBand whole = flat_band(10.0f);
  ContactBand band = whole;
  band.trim_envelope(6.0f);
  std::size_t expected = 0;
  for (const ContactBand::Node& node : whole.nodes) {
    const float far = glm::distance(glm::vec3(node.x, node.y, node.z), whole.samples[node.sample].position);
    const bool kept = far <= (static_cast<float>(node.z) < kPlane ? 10.0f : 6.0f);
    expected += kept;
    const std::uint32_t n = band.at({node.x, node.y, node.z});
    ASSERT_EQ(n != ContactBand::kNone, kept) << node.x << ' ' << node.y << ' ' << node.z;
    if (kept) {
      ASSERT_EQ(band.point(n), glm::ivec3(node.x, node.y, node.z));
    }
  }
  EXPECT_EQ(band.nodes.size(), expected);
  EXPECT_LT(expected, whole.nodes.size());
  EXPECT_EQ(band.reach_at(-1.0f), 10.0f);
  EXPECT_EQ(band.reach_at(1.0f), 6.0f);
}

/// Samples of a sheet that bends both ways, about a step apart, and a few by themselves.
std::vector<PatchPoint> wavy_samples(std::uint32_t seed, std::int64_t edge) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0.0f, 1.0f);
  const float phase = 6.0f * share(random), rise = 3.0f + 4.0f * share(random);
  const auto end = static_cast<float>(edge);
  std::vector<PatchPoint> samples;
  for (float y = 9.0f; y < end - 9.0f; y += 0.9f)
    for (float x = 9.0f; x < end - 9.0f; x += 0.9f) {
      const float sx = 0.13f * x + phase, sy = 0.11f * y;
      const glm::vec3 at(x + 0.4f * share(random), y + 0.4f * share(random),
                         0.5f * end + rise * std::sin(sx) * std::cos(sy));
      const glm::vec3 normal(-0.13f * rise * std::cos(sx) * std::cos(sy), 0.11f * rise * std::sin(sx) * std::sin(sy),
                             1.0f);
      samples.push_back({at, glm::normalize(normal)});
    }
  for (int k = 0; k < 5; ++k)
    samples.push_back({end * glm::vec3(share(random), share(random), share(random)), {1.0f, 0.0f, 0.0f}});
  return samples;
}

TEST(ContactBand, NodesAreAllPointsOfClayInReachOfASampleAndKnowTheNearest) {
  constexpr std::int64_t kWide = 61;
  for (const std::uint32_t seed : {3u, 4u, 5u, 6u}) {
    const std::vector<PatchPoint> samples = wavy_samples(seed, kWide);
    BitVolume inside(Dims{kWide, kWide, kWide});
    for (int z = 0; z < kWide; ++z)
      for (int y = 0; y < kWide; ++y)
        for (int x = 0; x < kWide; ++x) inside.set(x, y, z, (x * 7 + y * 5 + z * 3) % 11 != 0);
    const float reach = 5.0f + 2.3f * static_cast<float>(seed - 3);
    SilentProgress progress;
    const ContactBand band = ContactBand::make(inside, samples, reach, progress).value();
    std::size_t expected = 0, farther = 0, left_out = 0;
    for (int z = 1; z < kWide - 1; ++z)
      for (int y = 1; y < kWide - 1; ++y)
        for (int x = 1; x < kWide - 1; ++x) {
          float least = INFINITY;
          for (const PatchPoint& s : samples) least = std::min(least, glm::distance(glm::vec3(x, y, z), s.position));
          const std::uint32_t n = band.at({x, y, z});
          if (n == ContactBand::kNone) {
            left_out += inside.get(x, y, z) && least <= reach - 1e-3f;
            continue;
          }
          ++expected;
          const ContactBand::Node& node = band.nodes[n];
          const glm::vec3 off = glm::vec3(x, y, z) - samples[node.sample].position;
          ASSERT_NEAR(node.distance, glm::length(off), 1e-4f);
          ASSERT_NEAR(node.height, glm::dot(off, samples[node.sample].normal), 1e-4f);
          ASSERT_LE(node.distance, reach);
          ASSERT_LT(node.distance, least + 0.3f);
          farther += node.distance > least + 1e-4f;
        }
    EXPECT_EQ(band.nodes.size(), expected);
    EXPECT_LT(static_cast<double>(farther + left_out), 1e-3 * static_cast<double>(expected)) << seed;
  }
}

TEST(BandDensity, KeptWithRoomIsWhatWouldBeReadForABandThatHasMoved) {
  Volume<float> volume(Dims{kEdge, kEdge, kEdge});
  for (std::int64_t i = 0; i < volume.voxels.size(); ++i)
    volume.voxels[static_cast<std::size_t>(i)] = static_cast<float>(i * 7919 % 1009);
  VolumeSource source(volume);
  SilentProgress progress;
  const ContactBand before = flat_band(3.0f), after = flat_band(3.0f, kPlane + 7.0f);
  const BandDensity kept = BandDensity::read(before, source, progress, 2).value();
  const BandDensity read = BandDensity::read(after, source, progress).value();
  constexpr int kLooks = 6;  // as far as dips look from a node
  for (const ContactBand::Node& node : after.nodes)
    for (int z = node.z - kLooks; z <= node.z + kLooks; z += 3)
      for (int x = node.x - kLooks; x <= node.x + kLooks; x += 2)
        ASSERT_EQ(kept.get(x, node.y, z), read.get(x, node.y, z)) << x << ' ' << node.y << ' ' << z;
  EXPECT_NE(read.get(20, 20, 26), 0.0f);
}

TEST(BandDensity, KeptFromBandToBandIsWhatIsReadAnew) {
  Volume<float> volume(Dims{kEdge, kEdge, kEdge});
  for (std::int64_t i = 0; i < volume.voxels.size(); ++i)
    volume.voxels[static_cast<std::size_t>(i)] = static_cast<float>(i * 7919 % 1013 + 1);
  VolumeSource whole(volume);
  CountedSource source(whole);
  SilentProgress progress;
  BandDensity kept;
  struct Look {
    float plane;
    std::int64_t slices;  ///< that it has to read: layers of 8 where nothing was before
  };
  for (const Look look : {Look{5.5f, 24}, Look{7.5f, 0}, Look{27.5f, 16}, Look{29.5f, 0}, Look{9.5f, 0}}) {
    const ContactBand band = flat_band(3.0f, look.plane);
    source.slices = 0;
    ASSERT_TRUE(kept.follow(band, source, progress, {1, 1}).has_value());
    EXPECT_EQ(source.slices, look.slices) << look.plane;
    BandDensity here = kept;
    here.low_pass(band);
    const BandDensity anew = BandDensity::read(band, whole, progress).value();
    constexpr int kLooks = 7;  // as far as dips look from a node
    for (const ContactBand::Node& node : band.nodes) {
      ASSERT_EQ(here.get(node.x, node.y, node.z), anew.get(node.x, node.y, node.z));
      ASSERT_NE(here.get(node.x, node.y, node.z), 0.0f);
      for (int z = node.z - kLooks; z <= node.z + kLooks; ++z)
        for (int x = node.x - kLooks; x <= node.x + kLooks; x += 2)
          ASSERT_EQ(kept.raw().get(x, node.y, z), anew.raw().get(x, node.y, z)) << x << ' ' << node.y << ' ' << z;
    }
  }
}

}  // namespace
}  // namespace dubsar
