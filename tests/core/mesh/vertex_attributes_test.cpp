#include "core/mesh/vertex_attributes.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

/// A mesh with one attribute more, and the list with one entry more: all that it takes to carry it along.
struct MeshWithGloss : TriMesh {
  std::vector<float> gloss;
};
constexpr auto kWithGloss =
    std::tuple_cat(kVertexAttributes, std::tuple{VertexAttribute{"gloss", &MeshWithGloss::gloss}});

MeshWithGloss triangle_and_spare() {
  MeshWithGloss mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}};
  mesh.k_min = {0, 1, 2, 3};
  mesh.colors = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}};
  mesh.gloss = {0.5f, 1.5f, 2.5f, 3.5f};
  return mesh;
}

TEST(VertexAttributes, ASampleAttributeIsGatheredJoinedAndCheckedByItsEntryAlone) {
  const MeshWithGloss mesh = triangle_and_spare();
  MeshWithGloss some;
  gather_vertices(mesh, std::vector<std::uint32_t>{3, 1}, some, kWithGloss);
  EXPECT_EQ(some.gloss, (std::vector<float>{3.5f, 1.5f}));
  EXPECT_EQ(some.k_min, (std::vector<float>{3, 1}));
  EXPECT_EQ(some.positions[0], glm::vec3(9.0f));
  EXPECT_TRUE(some.normals.empty());

  append_vertices(some, mesh, kWithGloss);
  EXPECT_EQ(some.gloss, (std::vector<float>{3.5f, 1.5f, 0.5f, 1.5f, 2.5f, 3.5f}));
  EXPECT_EQ(some.positions.size(), 6u);

  MeshWithGloss broken = mesh;
  broken.gloss.pop_back();
  EXPECT_TRUE(check_arrays(broken, ErrorKind::kBadData, "test"));
  EXPECT_EQ(check_arrays(broken, ErrorKind::kBadData, "test", kWithGloss).error().message,
            "test: the mesh has 4 vertices but 3 gloss, expected as many or none");
}

TEST(VertexAttributes, WhatOnlyOneOfTwoMeshesKnowsIsDropped) {
  MeshWithGloss joined = triangle_and_spare(), other = triangle_and_spare();
  other.colors.clear();
  append_vertices(joined, other, kWithGloss);
  EXPECT_TRUE(joined.colors.empty());
  EXPECT_EQ(joined.gloss.size(), 8u);
  EXPECT_TRUE(check_arrays(joined, ErrorKind::kBadData, "test", kWithGloss));
}

TEST(VertexAttributes, EveryContradictionOfAMeshIsFound) {
  const TriMesh good = triangle_and_spare();
  ASSERT_TRUE(check_arrays(good, ErrorKind::kInternal, "test"));
  for_each_attribute([&](const auto& attribute) {
    TriMesh bad = good;
    (bad.*attribute.values).resize(3);
    const auto refused = check_arrays(bad, ErrorKind::kInternal, "test");
    ASSERT_FALSE(refused) << attribute.name;
    EXPECT_EQ(refused.error().kind, ErrorKind::kInternal);
    EXPECT_NE(refused.error().message.find(attribute.name), std::string::npos);
  });
  TriMesh bad = good;
  bad.triangles[0][1] = 4;
  EXPECT_FALSE(check_arrays(bad, ErrorKind::kBadData, "test"));
  bad = good;
  bad.triangle_partition = {0, 0};
  EXPECT_FALSE(check_arrays(bad, ErrorKind::kBadData, "test"));
  bad.triangle_partition = {8};
  EXPECT_FALSE(check_arrays(bad, ErrorKind::kBadData, "test"));
}

}  // namespace
}  // namespace dubsar
