#include "core/contact/clay_cavities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

constexpr int kEdge = 56;
constexpr float kPlane = 28.0f;  ///< height of the patch
constexpr float kReach = 12.0f;

/// Clay everywhere around a flat patch.
ContactBand band_in_clay() {
  BitVolume inside(Dims{kEdge, kEdge, kEdge});
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) inside.set(x, y, z, true);
  std::vector<PatchPoint> samples;
  for (int y = 13; y < kEdge - 12; ++y)
    for (int x = 13; x < kEdge - 12; ++x) samples.push_back({{x, y, kPlane}, {0.0f, 0.0f, 1.0f}});
  SilentProgress progress;
  return ContactBand::make(inside, std::move(samples), kReach, progress).value();
}

const glm::vec3 kPore{30.3f, 27.2f, kPlane - 7.4f};

TEST(BlindFringes, ClayBesideACavityShowsNoFilmAndFartherClayStaysAsItIs) {
  const ContactBand band = band_in_clay();
  ClayCavity pore;
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    if (glm::distance(glm::vec3(band.point(n)), kPore) < 2.3f) pore.push_back(n);
  const std::vector<ClayCavity> cavities{pore};
  Dips dips;
  dips.strength.assign(band.nodes.size(), 2.0f);
  dips.strength[0] = -1.0f;
  blind_fringes(band, cavities, dips);
  EXPECT_EQ(dips.strength[0], -1.0f);
  for (std::uint32_t n = 1; n < dips.strength.size(); ++n) {
    const float away = glm::distance(glm::vec3(band.point(n)), kPore);
    if (away < 3.5f) {
      EXPECT_LE(dips.strength[n], 0.0f) << away;
    } else if (away > 2.9f + 3.0f) {
      EXPECT_EQ(dips.strength[n], 2.0f) << away;
    }
  }
}

}  // namespace
}  // namespace dubsar
