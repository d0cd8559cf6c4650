#include "app/publish/surface_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

namespace dubsar::app {
namespace {
using ::testing::HasSubstr;

/// A closed box of this size about a point, its triangles labelled; `turn` after that.
void add_box(TriMesh& mesh, const glm::dvec3& size, const glm::dmat3& turn, PartitionId label) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int k = 0; k < 8; ++k)
    mesh.positions.emplace_back(turn * ((glm::dvec3(k & 1, k >> 1 & 1, k >> 2 & 1) - 0.5) * size));
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : kFaces) {
    mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    mesh.triangles.push_back({first + f[0], first + f[2], first + f[3]});
    mesh.triangle_partition.insert(mesh.triangle_partition.end(), 2, label);
  }
}

TriMesh envelope_and_tablet(const glm::dmat3& turn) {
  TriMesh mesh;
  mesh.frame.input_voxel.provenance = "test";
  mesh.partitions = {{0, "tablet", "", 0, 0, true, PartitionKind::kTablet},
                     {1, "envelope outside", "envelope", 0, 0, true, PartitionKind::kEnvelopeOutside}};
  add_box(mesh, {30, 40, 12}, turn, 0);
  add_box(mesh, {36, 47, 18}, turn, 1);
  mesh.triangle_inferred.assign(mesh.triangles.size(), 0);
  mesh.triangle_inferred[2] = mesh.triangle_inferred[3] = 1;  // one broad side of the tablet
  return mesh;
}

TEST(SurfaceFacts, SizesAreThoseOfABoxHoweverItLiesInTheScan) {
  for (const double angle : {0.0, 0.3, 1.1}) {
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle, glm::normalize(glm::dvec3(1, 2, -0.5))));
    const auto facts = surface_facts(envelope_and_tablet(turn));
    ASSERT_TRUE(facts) << facts.error().message;
    ASSERT_EQ(facts->parts.size(), 2u);
    for (const auto& [part, expected] :
         {std::pair{facts->parts[0], glm::dvec3(12, 30, 40)}, std::pair{facts->parts[1], glm::dvec3(18, 36, 47)}}) {
      std::array<double, 3> sides{part.size.x, part.size.y, part.size.z};
      EXPECT_NEAR(part.size.z, expected.x, 1e-3) << "the thickness comes last";
      std::sort(sides.begin(), sides.end());
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(sides[static_cast<std::size_t>(k)], expected[k], 1e-3) << angle;
      EXPECT_TRUE(part.watertight);
    }
    EXPECT_NEAR(facts->parts[0].volume, 30 * 40 * 12, 0.01);
    EXPECT_NEAR(facts->parts[0].area, 2 * (30 * 40 + 30 * 12 + 40 * 12), 0.01);
    EXPECT_NEAR(facts->parts[0].inferred_area, 1200, 0.01);
    EXPECT_NEAR(facts->parts[0].inferred_share(), 1200.0 / 4080.0, 1e-6);
    EXPECT_EQ(facts->parts[1].inferred_area, 0.0);
  }
}

TEST(SurfaceFacts, EachKindOfEvidenceIsMeasuredPerSide) {
  TriMesh mesh = envelope_and_tablet(glm::dmat3(1.0));
  mesh.evidence.assign(mesh.positions.size(), evidence_byte(Evidence::kMeasured));
  // Of the tablet's twelve triangles one broad side is inferred, the other is a film, but for what it shares.
  for (const std::uint32_t v : mesh.triangles[0]) mesh.evidence[v] = evidence_byte(Evidence::kFilm);
  const SurfaceFacts facts = surface_facts(mesh).value();
  const PartFacts& tablet = facts.parts[0];
  double all = 0.0;
  for (const auto& [evidence, name, short_name] : kEvidences) all += tablet.evidence_area(evidence);
  EXPECT_NEAR(all, tablet.area, 1e-6);
  EXPECT_NEAR(tablet.evidence_area(Evidence::kInferred), 1200.0, 0.01);
  const auto inferred = static_cast<std::size_t>(Evidence::kInferred), film = static_cast<std::size_t>(Evidence::kFilm);
  EXPECT_NEAR(tablet.sides[0][inferred] + tablet.sides[1][inferred], 1200.0, 0.01) << "a broad side";
  EXPECT_NEAR(tablet.sides[0][film] + tablet.sides[1][film], 1200.0, 0.01) << "the other one";
  EXPECT_EQ(std::min(tablet.sides[0][film], tablet.sides[1][film]), 0.0);
  for (std::size_t side = 2; side < 6; ++side) EXPECT_EQ(tablet.sides[side][inferred], 0.0) << kEvidenceSides[side];
  EXPECT_EQ(facts.parts[1].evidence_area(Evidence::kFilm), 0.0);
  const nlohmann::json json = facts_json(facts);
  EXPECT_NEAR(json["parts"][0]["evidence"]["inferred"], 1200.0, 0.01);
  EXPECT_NEAR(json["evidence"]["film_area"], tablet.evidence_area(Evidence::kFilm), 1e-6);
  EXPECT_EQ(json["parts"][0]["sides"].size(), 6u);
  const std::string text = facts_text(facts);
  EXPECT_THAT(text, HasSubstr("How the tablet is known, mm2"));
  EXPECT_THAT(text, HasSubstr("obverse"));
}

TEST(SurfaceFacts, TheTextFitsSixtyColumnsAndSaysWhatItIs) {
  const auto facts = surface_facts(envelope_and_tablet(glm::dmat3(1.0)));
  ASSERT_TRUE(facts);
  EXPECT_EQ(what_it_is(*facts), "a tablet inside its envelope");
  const std::string text = facts_text(*facts);
  EXPECT_THAT(text, HasSubstr("14.4 cm3"));
  EXPECT_THAT(text, HasSubstr("1200 mm2, 29.4 % of its surface"));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 60u) << line;
  const nlohmann::json json = facts_json(*facts);
  EXPECT_EQ(json["unit"], "mm");
  EXPECT_NEAR(json["evidence"]["inferred_area"].get<double>(), 1200, 0.01);
  EXPECT_NEAR(json["box"][1].get<double>(), 47, 1e-3);
}

TEST(SurfaceFacts, WithoutAVoxelSizeNothingIsCalledAMillimetre) {
  TriMesh mesh = envelope_and_tablet(glm::dmat3(1.0));
  mesh.frame.input_voxel.provenance.clear();
  const auto facts = surface_facts(mesh);
  ASSERT_TRUE(facts);
  EXPECT_FALSE(facts->millimetres);
  EXPECT_THAT(facts_text(*facts), ::testing::Not(HasSubstr("mm")));
  EXPECT_EQ(facts_json(*facts)["unit"], "voxel");
}

TEST(SurfaceFacts, BodiesOfAClosedSurfaceAreClosedWhereTheyShareNothing) {
  TriMesh mesh = envelope_and_tablet(glm::dmat3(1.0));
  const auto tight = [&](bool closed) {
    std::vector<bool> out;
    const SurfaceFacts facts = surface_facts(mesh, closed).value();
    for (const PartFacts& part : facts.parts) out.push_back(part.watertight);
    return out;
  };
  EXPECT_EQ(tight(true), (std::vector<bool>{true, true}));
  EXPECT_EQ(tight(false), tight(true));
  mesh.triangle_partition[1] = 1;  // a triangle of the tablet is said to be of the envelope: neither is closed
  EXPECT_EQ(tight(true), (std::vector<bool>{false, false})) << "they share vertices: each is looked at";
}

TEST(SurfaceFacts, AnEmptySurfaceIsRefused) { EXPECT_EQ(surface_facts(TriMesh()).error().kind, ErrorKind::kBadData); }

}  // namespace
}  // namespace dubsar::app
