#include "core/contact/labelled/contact_sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

constexpr std::int64_t kSheetEdge = 40;

/// Clay everywhere, and patches along a level plane below the oblique one.
ContactBand band_of_clay() {
  BitVolume inside(Dims{kSheetEdge, kSheetEdge, kSheetEdge});
  for (int z = 0; z < kSheetEdge; ++z)
    for (int y = 0; y < kSheetEdge; ++y)
      for (int x = 0; x < kSheetEdge; ++x) inside.set(x, y, z, true);
  std::vector<PatchPoint> samples;
  for (int y = 4; y < kSheetEdge - 4; ++y)
    for (int x = 4; x < kSheetEdge - 4; ++x)
      samples.push_back({{static_cast<float>(x), static_cast<float>(y), 19.0f}, {0, 0, 1}});
  SilentProgress progress;
  return ContactBand::make(inside, std::move(samples), 9.0f, progress).value();
}

const glm::vec3 kNormal = glm::normalize(glm::vec3(0.08f, -0.11f, 1.0f));
float over_plane(const glm::vec3& p) { return glm::dot(p - glm::vec3(20.0f, 20.0f, 21.6f), kNormal); }

InterfaceMesh oblique_sheet() {
  return sheet(31, [](int i, int j) {
    const float x = static_cast<float>(i) + 5.0f, y = static_cast<float>(j) + 5.0f;
    return glm::vec3(x, y, 21.6f - (0.08f * (x - 20.0f) - 0.11f * (y - 20.0f)));
  });
}

bool over_the_middle(const glm::ivec3& p) { return p.x > 8 && p.x < 32 && p.y > 8 && p.y < 32; }

TEST(ContactSheet, DistancesAreThoseOfThePlane) {
  const ContactBand band = band_of_clay();
  const std::vector<float> distances = distances_from_sheet(band, oblique_sheet(), {});
  int known = 0, rim = 0;
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n) {
    const glm::ivec3 p = band.point(n);
    const float wanted = over_plane(glm::vec3(p));
    if (over_the_middle(p) && std::abs(wanted) < 1.7f) {
      EXPECT_NEAR(distances[n], wanted, 1e-4f);
      ++known;
    }
    EXPECT_TRUE(std::abs(wanted) < 1.9f || !std::isfinite(distances[n]));
    rim += std::isinf(distances[n]);
  }
  EXPECT_GT(known, 1500);
  EXPECT_GT(rim, 100) << "beyond the rim nobody knows the side";
}

TEST(ContactSheet, WhatLiesBetweenTheCutAndTheSheetChangesSides) {
  const ContactBand band = band_of_clay();
  std::vector<ClaySide> side(band.nodes.size());
  for (std::uint32_t n = 0; n < side.size(); ++n)  // the cut, up to three steps below
    side[n] = band.nodes[n].z > 19 ? ClaySide::kEnvelope : ClaySide::kTablet;
  follow_sheet(band, distances_from_sheet(band, oblique_sheet(), {}), 4, 64, side);
  int wrong = 0, all = 0;
  for (std::uint32_t n = 0; n < side.size(); ++n) {
    if (!over_the_middle(band.point(n))) continue;
    ++all;
    wrong += (over_plane(glm::vec3(band.point(n))) > 0.0f) != (side[n] == ClaySide::kEnvelope);
  }
  EXPECT_EQ(wrong, 0) << "of " << all;
}

TEST(ContactSheet, WhatATurnedTriangleGivesToTheOtherClayStaysAsItWas) {
  const ContactBand band = band_of_clay();
  std::vector<ClaySide> before(band.nodes.size());
  std::vector<float> distances(band.nodes.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::uint32_t n = 0; n < before.size(); ++n)
    before[n] = band.nodes[n].z > 22 ? ClaySide::kEnvelope : ClaySide::kTablet;
  distances[band.at({20, 20, 16})] = 1.0f;  // what is four steps from it and less would go with it: 129 nodes
  std::vector<ClaySide> side = before;
  follow_sheet(band, distances, 4, 64, side);
  EXPECT_EQ(side, before);
}

TEST(ContactSheet, ClayAtAirKeepsItsSide) {
  const ContactBand band = band_of_clay();
  const std::vector<ClaySide> before(band.nodes.size(), ClaySide::kTablet);
  std::vector<ClaySide> side = before;
  follow_sheet(band, distances_from_sheet(band, oblique_sheet(), {}), 4, 64, side);
  for (std::uint32_t n = 0; n < side.size(); ++n) {
    bool at_end = false;
    each_beside(band.point(n), [&](const glm::ivec3& q) { at_end = at_end || band.at(q) == ContactBand::kNone; });
    if (at_end && band.nodes[n].z < 24) {
      EXPECT_EQ(side[n], before[n]);
    }
  }
}

}  // namespace
}  // namespace dubsar
