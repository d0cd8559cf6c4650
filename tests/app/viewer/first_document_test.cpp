// How parts of a document stand on the stage, and what of the surface is known.

#include "app/viewer/first_document.h"

#include <gtest/gtest.h>

#include "app/tools/surface_tools.h"

namespace dubsar::app {
namespace {

constexpr int kTablet = 0, kOutside = 1, kInside = 2, kPores = 3, kOthers = 4;

/// Places of the parts do not matter here, but for a box of 20 x 12 x 40.
TriMesh divided() {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {20, 12, 40}, {20, 0, 40}};
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_partition = {0};
  mesh.partitions = {{.id = kTablet, .name = "tablet"},
                     {.id = kOutside, .name = "envelope outside", .body = "envelope"},
                     {.id = kInside, .name = "envelope inside", .body = "envelope"},
                     {.id = kPores, .name = "pores and crumbs", .body = "pores and crumbs", .within = "envelope"},
                     {.id = kOthers, .name = "pores and crumbs", .body = "pores and crumbs", .within = "tablet"}};
  return mesh;
}

const Box kBox{{0, 0, 0}, {20, 12, 40}};

PartLooks looks_of(const Document& document) { return laid_out(document, PartLooks{}, kBox); }

TEST(LaidOut, PoresGoWithTheClayThatTheyLieIn) {
  Document document = first_document({}, divided()).document;
  ASSERT_EQ(document.parts.size(), 3u);
  document.unpack = 1.0;
  const PartLooks looks = looks_of(document);
  EXPECT_EQ(looks[kPores].offset_mm, looks[kOutside].offset_mm);
  EXPECT_EQ(looks[kInside].offset_mm, looks[kOutside].offset_mm);
  EXPECT_EQ(looks[kOthers].offset_mm, looks[kTablet].offset_mm);
  // Apart by all of the height and a tenth, along the object's upright axis.
  EXPECT_NEAR(looks[kOutside].offset_mm.z - looks[kTablet].offset_mm.z, 1.1 * 40, 1e-9);
  EXPECT_NEAR(looks[kOutside].offset_mm.z + looks[kTablet].offset_mm.z, 0.0, 1e-9);
}

TEST(LaidOut, PoresAreMovedHiddenAndSeenThroughWithTheirBody) {
  Document document = first_document({}, divided()).document;
  const auto part = [&](const char* name) -> Part& {
    return *std::find_if(document.parts.begin(), document.parts.end(), [&](const Part& p) { return p.name == name; });
  };
  part("envelope").offset_mm = {1, 2, 3};
  part("envelope").opacity = 0.5;
  part("pores and crumbs").offset_mm = {10, 0, 0};
  PartLooks looks = looks_of(document);
  EXPECT_EQ(looks[kPores].offset_mm, glm::dvec3(11, 2, 3));
  EXPECT_EQ(looks[kOthers].offset_mm, glm::dvec3(10, 0, 0));
  EXPECT_EQ(looks[kPores].opacity, 0.5);
  EXPECT_EQ(looks[kOthers].opacity, 1.0);
  part("envelope").visible = false;
  looks = looks_of(document);
  EXPECT_FALSE(looks[kPores].visible);
  EXPECT_TRUE(looks[kOthers].visible);
  EXPECT_EQ(visible_partitions(document), 1 << kTablet | 1 << kOthers);
}

TEST(FirstDocument, WhatWasChosenOfPartsHoldsForPartsOfThatNameInAnotherSurface) {
  Document kept;
  kept.parts = {Part{.name = "envelope", .partitions = 1 << 7, .visible = false, .opacity = 0.25},
                Part{.name = "fragment 1", .partitions = 2}};
  ViewOptions options;
  options.work.document = kept;
  const Document document = first_document(options, divided()).document;
  ASSERT_EQ(document.parts.size(), 3u);
  EXPECT_EQ(document.parts[1].name, "envelope");
  EXPECT_EQ(document.parts[1].partitions, 1 << kOutside | 1 << kInside);
  EXPECT_EQ(document.parts[1].pores, 1 << kPores);
  EXPECT_FALSE(document.parts[1].visible);
  EXPECT_EQ(document.parts[1].opacity, 0.25);
}

// Two bodies of 6 x 4 that touch along a patch of 4 x 4: each has 8 of its own, and pores have 100.
TEST(SurfaceEvidence, PatchesThatCloseTwoBodiesCountOnceAndHiddenOnesNot) {
  TriMesh mesh;
  mesh.partitions = {{.id = 0, .name = "tablet"}, {.id = 1, .name = "envelope"}, {.id = 2, .name = "pores and crumbs"}};
  const auto add = [&](const glm::vec3& a, const glm::vec3& b, bool turned, PartitionId id, bool inferred) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, {b.x, a.y, 0}, b, {a.x, b.y, 0}});
    for (Triangle t : {Triangle{first, first + 1, first + 2}, Triangle{first, first + 2, first + 3}}) {
      if (turned) std::swap(t[1], t[2]);
      mesh.triangles.push_back(t);
      mesh.triangle_partition.push_back(id);
      mesh.triangle_inferred.push_back(inferred);
    }
  };
  add({0, 0, 0}, {2, 4, 0}, false, 0, false);
  add({2, 0, 0}, {6, 4, 0}, false, 0, true);
  add({2, 0, 0}, {6, 4, 0}, true, 1, true);
  add({6, 0, 0}, {8, 4, 0}, true, 1, false);
  add({20, 0, 0}, {30, 10, 0}, false, 2, false);
  const SurfaceEvidence evidence(mesh);
  EXPECT_EQ(evidence.of(0b111), (EvidenceShares{16, 16}));
  EXPECT_EQ(evidence.of(0b011), (EvidenceShares{16, 16}));
  EXPECT_EQ(evidence.of(0b001), (EvidenceShares{8, 16}));
  EXPECT_EQ(evidence.of(0b010), (EvidenceShares{8, 16}));
  EXPECT_EQ(evidence.of(0b100), (EvidenceShares{0, 0}));
}

}  // namespace
}  // namespace dubsar::app
