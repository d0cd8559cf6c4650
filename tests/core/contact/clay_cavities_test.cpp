#include "core/contact/clay_cavities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

constexpr int kEdge = 56;
constexpr float kPlane = 28.0f;  ///< height of the patch
constexpr float kReach = 12.0f;
constexpr float kIsovalue = 0.5f;

using Field = std::function<float(const glm::vec3&)>;  ///< air, steps into it

float ball(const glm::vec3& p, const glm::vec3& centre, float radius) { return radius - glm::distance(p, centre); }

/// Clay of density 1 and air of density 0 in it, and a flat patch. Of the air the signs know what `known` says.
struct Scan {
  BitVolume inside{Dims{kEdge, kEdge, kEdge}};
  ContactBand band;
  BandDensity density;

  explicit Scan(
      const Field& air, const Field& known = [](const glm::vec3&) { return -1.0f; })
      : band(make_band(known)), density(make_density(air)) {}

  std::vector<ClayCavity> cavities() const { return unseen_cavities(band, inside, density, kIsovalue); }

 private:
  ContactBand make_band(const Field& known) {
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) inside.set(x, y, z, known(glm::vec3(x, y, z)) <= 0.0f);
    std::vector<PatchPoint> samples;
    for (int y = 13; y < kEdge - 12; ++y)
      for (int x = 13; x < kEdge - 12; ++x) samples.push_back({{x, y, kPlane}, {0.0f, 0.0f, 1.0f}});
    SilentProgress progress;
    return ContactBand::make(inside, std::move(samples), kReach, progress).value();
  }
  BandDensity make_density(const Field& air) const {
    Volume<float> scan(Dims{kEdge, kEdge, kEdge});
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) scan.at(x, y, z) = std::clamp(0.5f - air(glm::vec3(x, y, z)), 0.0f, 1.0f);
    VolumeSource source(scan);
    SilentProgress progress;
    return BandDensity::read(band, source, progress).value();
  }
};

const glm::vec3 kPore{30.3f, 27.2f, kPlane - 7.4f};

TEST(UnseenCavities, APoreWithoutASurfaceIsOne) {
  const Scan scan([](const glm::vec3& p) { return ball(p, kPore, 2.3f); });
  const auto cavities = scan.cavities();
  ASSERT_EQ(cavities.size(), 1u);
  for (const std::uint32_t n : cavities[0])
    EXPECT_LT(glm::distance(glm::vec3(scan.band.point(n)), kPore), 2.9f) << "a step of low pass beyond its wall";
  EXPECT_TRUE(std::is_sorted(cavities[0].begin(), cavities[0].end()));
}

TEST(UnseenCavities, AWideFilmAndAWedgeUnderItAreNone) {
  // Two steps of air, dark enough to be taken for a cavity, along the patch and down a wedge 6 steps deep.
  const Scan scan([](const glm::vec3& p) {
    const float aside = std::abs(p.x - 28.0f);
    const float sheet = kPlane + 0.2f - std::max(0.0f, 6.0f - 1.5f * aside);
    return 1.0f - std::abs(p.z - sheet) / (aside < 4.0f ? 1.8f : 1.0f);
  });
  const auto dark = std::count_if(scan.band.nodes.begin(), scan.band.nodes.end(), [&](const ContactBand::Node& node) {
    return scan.density.get(node.x, node.y, node.z) < kIsovalue;
  });
  EXPECT_GT(dark, 1000) << "the film is too light to be mistaken";
  EXPECT_TRUE(scan.cavities().empty());
}

TEST(UnseenCavities, AirThatHasASurfaceIsNone) {
  // What is left dark around a pore that the signs have somewhat too small.
  const Scan scan([](const glm::vec3& p) { return ball(p, kPore, 3.0f); },
                  [](const glm::vec3& p) { return ball(p, kPore, 1.6f); });
  EXPECT_TRUE(scan.cavities().empty());
}

TEST(BlindFringes, ClayBesideACavityShowsNoFilmAndFartherClayStaysAsItIs) {
  const Scan scan([](const glm::vec3& p) { return ball(p, kPore, 2.3f); });
  const auto cavities = scan.cavities();
  ASSERT_EQ(cavities.size(), 1u);
  Dips dips;
  dips.strength.assign(scan.band.nodes.size(), 2.0f);
  dips.strength[0] = -1.0f;
  blind_fringes(scan.band, cavities, dips);
  EXPECT_EQ(dips.strength[0], -1.0f);
  for (std::uint32_t n = 1; n < dips.strength.size(); ++n) {
    const float away = glm::distance(glm::vec3(scan.band.point(n)), kPore);
    if (away < 3.5f) {
      EXPECT_LE(dips.strength[n], 0.0f) << away;
    } else if (away > 2.9f + 3.0f) {
      EXPECT_EQ(dips.strength[n], 2.0f) << away;
    }
  }
}

}  // namespace
}  // namespace dubsar
