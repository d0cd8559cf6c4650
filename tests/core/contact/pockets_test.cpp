#include "core/contact/pockets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <set>
#include <utility>

#include "core/contact/clay_cavities.h"
#include "core/contact/clay_sides.h"
#include "tests/core/parts/grid_scene.h"

namespace dubsar {
namespace {

constexpr int kPocketEdge = 64;
constexpr float kPatchPlane = 32.0f;  ///< height of the patch
constexpr float kPocketReach = 12.0f;

/// A wedge 8 steps deep and as wide, under the plane: a cone with its tip down.
float wedge(const glm::vec3& p, const glm::vec3& mouth) {
  const float below = mouth.z - p.z, aside = glm::length(glm::vec2(p.x - mouth.x, p.y - mouth.y));
  return std::min({below, 8.0f - below, 0.7f * (0.5f * (8.0f - below) - aside)});
}

/// A block of clay with cavities, and a flat patch across it.
struct CavityScene {
  SurfaceModel model;
  ContactBand band;
  std::vector<BandFace> faces;

  explicit CavityScene(const scene::Field& air) : model(make(air)), band(around_patch()) {
    const EdgeIndex index = EdgeIndex::create(model.samples).value();
    faces = faces_of_band(model, index, band);
  }

  /// Lowest and highest point of clay beside the cavity.
  std::pair<int, int> heights(const ClayCavity& cavity) const {
    std::pair<int, int> heights{kPocketEdge, 0};
    for (const std::uint32_t n : cavity) {
      heights.first = std::min(heights.first, band.point(n).z);
      heights.second = std::max(heights.second, band.point(n).z);
    }
    return heights;
  }

  RestPieces rest() const { return rest_pieces(model, faces); }
  /// With dips of the strength 3.5 where `dark` says so, and none elsewhere.
  template <class Dark>
  std::vector<ClayCavity> off_contact(const Dark& dark) const {
    std::vector<float> strength(band.nodes.size(), 0.0f);
    for (std::uint32_t n = 0; n < strength.size(); ++n)
      if (dark(glm::vec3(band.point(n)))) strength[n] = 3.5f;
    return cavities_off_contact(rest(), band, faces, strength);
  }
  std::vector<ClayCavity> off_contact() const {
    return off_contact([](const glm::vec3&) { return false; });
  }

 private:
  static SurfaceModel make(const scene::Field& air) {
    SurfaceModel made = scene::extract_model({kPocketEdge, kPocketEdge, kPocketEdge}, [&](const glm::vec3& p) {
      return std::min(scene::box(p, glm::vec3(32.0f), glm::vec3(29.0f), 3.0f), -air(p));
    });
    made.partitions.add(PartitionKind::kTablet);
    made.partitions.add(PartitionKind::kEnvelopeInside, "envelope");
    const PartitionId pores = made.partitions.add(PartitionKind::kPores);
    for (const auto& quad : made.mesh.quads) {
      const glm::vec3 off = glm::abs(made.mesh.positions[quad[0]] - glm::vec3(32.0f));
      made.quad_partition.push_back(std::max({off.x, off.y, off.z}) < 25.0f ? pores : PartitionId{0});
    }
    return made;
  }
  ContactBand around_patch() const {
    std::vector<PatchPoint> samples;
    for (int y = 17; y < kPocketEdge - 16; ++y)
      for (int x = 17; x < kPocketEdge - 16; ++x) samples.push_back({{x, y, kPatchPlane}, {0.0f, 0.0f, 1.0f}});
    SilentProgress progress;
    return ContactBand::make(model.samples.signs, std::move(samples), kPocketReach, progress).value();
  }
};

constexpr glm::vec3 kPore{38.3f, 32.2f, kPatchPlane - 7.6f};
float pore(const glm::vec3& p) { return scene::ball(p, kPore, 2.2f); }

TEST(RestPieces, APoreIsOneClosedPieceOfItsVolumeWhoseFacesAreMutuallyBesideEachOther) {
  const CavityScene scene(pore);
  const RestPieces rest = scene.rest();
  ASSERT_EQ(rest.all.size(), 1u);
  const RestPiece& piece = rest.all[0];
  EXPECT_NEAR(piece.volume, -35.0, 10.0) << "of a ball of 44.6, whose faces are chords";
  ASSERT_EQ(piece.first_side.size(), piece.quads.size() + 1);
  ASSERT_EQ(piece.first_side.back(), piece.beside.size());
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> across;
  for (std::size_t i = 0; i < piece.quads.size(); ++i) {
    EXPECT_GE(piece.first_side[i + 1] - piece.first_side[i], 4u);
    for (std::uint32_t s = piece.first_side[i]; s < piece.first_side[i + 1]; ++s)
      across.emplace(piece.quads[i], piece.beside[s]);
  }
  for (const auto& [from, to] : across) EXPECT_EQ(across.count({from, to}), across.count({to, from}));
}

TEST(CavitiesOffContact, APoreInTheClayIsOneAndAWedgeThatOpensToTheContactIsNot) {
  const CavityScene scene([](const glm::vec3& p) {
    return std::max(pore(p), wedge(p, {24.2f, 32.1f, kPatchPlane + 0.3f}));
  });
  const auto off = scene.off_contact();
  ASSERT_EQ(off.size(), 1u);
  const auto [low, high] = scene.heights(off[0]);
  EXPECT_GE(low, 20);
  EXPECT_LE(high, 28) << "the pore is between 22.2 and 26.6, the wedge between 24 and 32";
}

TEST(CavitiesOffContact, APocketOnAPatchThatMissesItsMouthIsNone) {
  const CavityScene scene([](const glm::vec3& p) { return wedge(p, {32.2f, 32.1f, kPatchPlane - 2.7f}); });
  EXPECT_TRUE(scene.off_contact().empty());
}

TEST(CavitiesOffContact, WhereAFilmIsWidestThereIsNone) {
  const CavityScene scene(pore);
  const glm::vec3 across = glm::normalize(glm::vec3(0.6f, 0.3f, 1.0f));
  const auto off_sheet = [&](const glm::vec3& p) { return std::abs(glm::dot(p - kPore, across)); };
  EXPECT_TRUE(scene.off_contact([&](const glm::vec3& p) { return off_sheet(p) < 0.7f; }).empty());
  const auto stalk = [&](const glm::vec3& p) { return glm::length(glm::cross(p - kPore, across)) < 1.5f; };
  EXPECT_EQ(scene.off_contact(stalk).size(), 1u) << "straw";
  const auto beside = [&](const glm::vec3& p) { return off_sheet(p) > 8.2f && off_sheet(p) < 9.2f; };
  EXPECT_EQ(scene.off_contact(beside).size(), 1u) << "a film passes by";
  const auto fringe = [&](const glm::vec3& p) { return glm::length(p - kPore) < 4.5f; };
  EXPECT_EQ(scene.off_contact(fringe).size(), 1u) << "of its own air";
}

TEST(KeepWhole, TheClayAtACavityIsOfOneSide) {
  const CavityScene scene(pore);
  const std::vector<ClayCavity> off = scene.off_contact();
  ASSERT_EQ(off.size(), 1u);
  for (const ClaySide most : {ClaySide::kTablet, ClaySide::kEnvelope}) {
    const ClaySide other = most == ClaySide::kTablet ? ClaySide::kEnvelope : ClaySide::kTablet;
    std::vector<ClaySide> side(scene.band.nodes.size(), other);  // all clay around it is of the other side
    for (const std::uint32_t n : off[0]) side[n] = most;
    side[off[0][3]] = other;
    EXPECT_TRUE(keep_whole(scene.band, off, side));
    for (const std::uint32_t n : off[0]) {
      EXPECT_EQ(side[n], most);
      each_beside(scene.band.point(n), [&](const glm::ivec3& p) {  // so that they hang together through clay
        if (const std::uint32_t m = scene.band.at(p); m != ContactBand::kNone) {
          EXPECT_EQ(side[m], most);
        }
      });
    }
    const std::vector<ClaySide> before = side;
    EXPECT_FALSE(keep_whole(scene.band, off, side));
    EXPECT_EQ(side, before);
  }
}

TEST(DivideClay, GoesRoundACavityThatIsWhole) {
  const CavityScene scene(pore);
  const auto off = scene.off_contact();
  ASSERT_EQ(off.size(), 1u);
  // Clay that is dark by chance from the patch down to the pore, as wide as it.
  Dips dips;
  dips.strength.assign(scene.band.nodes.size(), 0.0f);
  for (std::uint32_t n = 0; n < dips.strength.size(); ++n) {
    const glm::vec3 p(scene.band.point(n));
    const float aside = glm::length(glm::vec2(p.x - 38.3f, p.y - 32.2f));
    if (p.z > kPatchPlane - 9.0f && p.z < kPatchPlane && aside < 6.0f && aside > 2.0f) dips.strength[n] = 3.0f;
  }
  const auto envelopes = [&](const std::vector<ClayCavity>& whole) {
    SilentProgress progress;
    auto hints = hints_of_faces(scene.model, scene.band, scene.faces, whole);
    for (std::uint32_t n = 0; n < dips.strength.size(); ++n) {  // the contact ends at the patch
      const glm::vec3 p(scene.band.point(n));
      if (std::max(std::abs(p.x - 32.0f), std::abs(p.y - 32.0f)) > 15.0f)
        hints.push_back({n, p.z < kPatchPlane ? ClaySide::kTablet : ClaySide::kEnvelope, kCertain});
    }
    const std::vector<ClaySide> side = ClayDivision({scene.band, dips, hints, {}, whole}).sides(progress).value();
    return std::count_if(off[0].begin(), off[0].end(), [&](std::uint32_t n) { return side[n] == ClaySide::kEnvelope; });
  };
  EXPECT_GT(envelopes({}), 0) << "nothing draws the cut to the pore";
  EXPECT_EQ(envelopes(off), 0);
}

}  // namespace
}  // namespace dubsar
