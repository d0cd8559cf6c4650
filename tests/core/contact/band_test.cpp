#include "core/contact/band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

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
