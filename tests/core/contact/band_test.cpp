#include "core/contact/band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

constexpr int kEdge = 40;
constexpr float kPlane = 19.5f;

ContactBand flat_band(float reach) {
  BitVolume inside(Dims{kEdge, kEdge, kEdge});
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) inside.set(x, y, z, true);
  std::vector<PatchPoint> samples;
  for (int y = 14; y < 26; ++y)
    for (int x = 14; x < 26; ++x) samples.push_back({{x, y, kPlane}, {0.0f, 0.0f, 1.0f}});
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

}  // namespace
}  // namespace dubsar
