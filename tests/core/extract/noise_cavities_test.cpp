// Cavities of noise become clay and leave samples as if they had never been; pores and everything open stay.

#include "core/extract/noise_cavities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/volume/volume.h"
#include "tests/core/extract/extract_help.h"

namespace dubsar {
namespace {

constexpr Dims kGrid{40, 36, 38};

/// A ball of clay (1) in air (0), with noise that repeats, and balls of air in it.
struct Pore {
  double x, y, z, radius, level;
};
Volume<float> clay_with(const std::vector<Pore>& pores, float noise) {
  Volume<float> volume(kGrid);
  std::uint32_t state = 1;
  for (std::int64_t z = 0; z < kGrid.z; ++z)
    for (std::int64_t y = 0; y < kGrid.y; ++y)
      for (std::int64_t x = 0; x < kGrid.x; ++x) {
        state = state * 1664525u + 1013904223u;
        const float some = noise * (static_cast<float>(state >> 8) / 8388608.0f - 1.0f) * std::sqrt(3.0f);
        const double from = std::hypot(double(x) - 19.5, double(y) - 17.5, double(z) - 18.5);
        float value = static_cast<float>(std::clamp(15.5 - from, 0.0, 1.0));
        for (const Pore& pore : pores)
          if (std::hypot(double(x) - pore.x, double(y) - pore.y, double(z) - pore.z) <= pore.radius)
            value = static_cast<float>(pore.level);
        volume.at(x, y, z) = value + (value > 0.5f ? some : 0.0f);
      }
  return volume;
}

NoiseCavities fill(SurfaceSamples& samples, const Volume<float>& volume) {
  VolumeSource source(volume);
  SilentProgress progress;
  return fill_noise_cavities(samples, source, {}, progress).value();
}

TEST(NoiseCavities, SmallOnesLeaveSamplesAsIfTheyHadNeverBeen) {
  // One point; two; an L of three; one beside the border of a word of 64 bits is not needed: rows are 40 wide.
  const std::vector<Pore> small{{19, 17, 18, 0.1, 0.2}, {12, 17, 18, 0.1, 0.0}, {13, 17, 18, 0.1, 0.3},
                                {19, 25, 12, 0.1, 0.1}, {20, 25, 12, 0.1, 0.1}, {20, 26, 12, 0.1, 0.1}};
  const Volume<float> with = clay_with(small, 0.0f), without = clay_with({}, 0.0f);
  SurfaceSamples samples = sample(with, 0.5f);
  const SurfaceSamples expected = sample(without, 0.5f);
  ASSERT_NE(samples.offsets.size(), expected.offsets.size());
  const NoiseCavities filled = fill(samples, with);
  EXPECT_EQ(filled.cavities, 3);
  EXPECT_EQ(filled.points, 6);
  EXPECT_EQ(samples, expected);
}

TEST(NoiseCavities, AmbiguousFacesInACavityGoWithIt) {
  // Two points across a face: one cavity, whose face decision goes, too.
  const std::vector<Pore> two{{19, 17, 18, 0.1, 0.2}, {20, 18, 18, 0.1, 0.2}};
  const Volume<float> with = clay_with(two, 0.0f);
  SurfaceSamples samples = sample(with, 0.5f);
  EXPECT_EQ(samples.joined.size(), sample(clay_with({}, 0.0f), 0.5f).joined.size() + 1);
  EXPECT_EQ(fill(samples, with).cavities, 1);
  EXPECT_EQ(samples, sample(clay_with({}, 0.0f), 0.5f));
}

TEST(NoiseCavities, PoresStayAndWhatIsFaintBesideTheNoiseGoes) {
  const Pore pore{19, 17, 18, 1.6, 0.1}, faint{19, 17, 18, 1.6, 0.45};  // 19 points each
  for (const float noise : {0.02f, 0.16f}) {
    const Volume<float> dark = clay_with({pore}, noise);
    SurfaceSamples samples = sample(dark, 0.5f);
    const SurfaceSamples before = samples;
    EXPECT_EQ(fill(samples, dark).cavities, 0) << noise;
    EXPECT_EQ(samples, before);
    const Volume<float> grey = clay_with({faint}, noise);
    SurfaceSamples of_grey = sample(grey, 0.5f);
    EXPECT_EQ(fill(of_grey, grey).cavities, noise > 0.1f ? 1 : 0) << noise;
  }
}

TEST(NoiseCavities, WhatIsOpenOrAtTheBorderStays) {
  // A point just under the surface that hangs together with the outside across a face, and clay to the border.
  Volume<float> volume(Dims{12, 12, 12});
  for (float& v : volume.voxels.span()) v = 1.0f;
  volume.at(0, 6, 6) = 0.0f;
  for (std::int64_t y = 0; y < 12; ++y)
    for (std::int64_t x = 0; x < 12; ++x) volume.at(x, y, 0) = 0.0f;
  volume.at(5, 5, 1) = 0.0f;
  volume.at(5, 6, 2) = 0.0f;
  SurfaceSamples samples = sample(volume, 0.5f);
  const SurfaceSamples before = samples;
  EXPECT_EQ(fill(samples, volume).cavities, 0);
  EXPECT_EQ(samples, before);
}

}  // namespace
}  // namespace dubsar
