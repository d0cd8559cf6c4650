// Pores and crumbs go with the body that they lie in or next to.

#include "core/mesh/pores_by_body.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

constexpr PartitionId kTablet = 0, kOutside = 1, kInside = 2, kPores = 3;

/// A box from `a` to `b`, its triangles seen counter-clockwise from outside, or from inside.
void add_box(TriMesh& mesh, const glm::vec3& a, const glm::vec3& b, PartitionId id, bool inside_out = false) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? b.x : a.x, i & 2 ? b.y : a.y, i & 4 ? b.z : a.z});
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : kFaces)
    for (Triangle t : {Triangle{f[0], f[1], f[2]}, Triangle{f[0], f[2], f[3]}}) {
      if (inside_out) std::swap(t[1], t[2]);
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      mesh.triangle_partition.push_back(id);
    }
}

/// A tablet of 20 x 12 x 40 in an envelope whose walls are 6 thick, 1 of air between them.
TriMesh tablet_in_envelope() {
  TriMesh mesh;
  mesh.partitions = {{.id = kTablet, .name = "tablet"},
                     {.id = kOutside, .name = "envelope outside", .body = "envelope"},
                     {.id = kInside, .name = "envelope inside", .body = "envelope"},
                     {.id = kPores, .name = "pores and crumbs"}};
  add_box(mesh, {0, 0, 0}, {20, 12, 40}, kTablet);
  add_box(mesh, {-7, -7, -7}, {27, 19, 47}, kOutside);
  add_box(mesh, {-1, -1, -1}, {21, 13, 41}, kInside, true);
  return mesh;
}

void add_pore(TriMesh& mesh, const glm::vec3& at) {
  add_box(mesh, at - glm::vec3(0.2f), at + glm::vec3(0.2f), kPores, true);
}

std::string owner_of_last(const TriMesh& mesh) { return mesh.partitions.find(mesh.triangle_partition.back())->within; }

TEST(PoresByBody, APoreBelongsToTheClayThatItLiesIn) {
  const std::vector<std::pair<glm::vec3, std::string>> cases{
      {{10, 6, 20}, "tablet"},    {{10, 11.5f, 20}, "tablet"},  {{10, 0.5f, 39}, "tablet"}, {{10, 14, 20}, "envelope"},
      {{10, -3, 20}, "envelope"}, {{10, 6, 44}, "envelope"},    {{-2, 6, 20}, "envelope"},  {{26, 18, 46}, "envelope"},
      {{0.5f, 6, 20}, "tablet"},  {{10, 13.5f, 20}, "envelope"}};
  TriMesh all = tablet_in_envelope();
  for (const auto& [at, owner] : cases) {
    TriMesh mesh = tablet_in_envelope();
    add_pore(mesh, at);
    add_pore(all, at);
    divide_pores(mesh);
    EXPECT_EQ(owner_of_last(mesh), owner) << at.x << " " << at.y << " " << at.z;
    EXPECT_EQ(mesh.partitions.size(), 4u) << "one owner: no further row";
  }
  const std::size_t bodies = 3 * 12;
  divide_pores(all);
  ASSERT_EQ(all.partitions.size(), 5u);
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t t = bodies + 12 * i; t < bodies + 12 * (i + 1); ++t)
      EXPECT_EQ(all.partitions.find(all.triangle_partition[t])->within, cases[i].second) << i;
  for (const Partition& row : all.partitions)
    if (row.kind == PartitionKind::kPores) {
      EXPECT_EQ(row.body_name(), "pores and crumbs") << "as one may name them";
    }
  for (std::size_t t = 0; t < bodies; ++t) EXPECT_EQ(all.triangle_partition[t], t / 12) << "bodies stay";
}

TEST(PoresByBody, ACrumbInTheAirBelongsToTheNearestSurface) {
  for (const auto& [at, owner] : std::vector<std::pair<glm::vec3, std::string>>{
           {{10, -0.3f, 20.3f}, "tablet"}, {{10, -0.75f, 20.3f}, "envelope"}, {{10, 60, 20}, "envelope"}}) {
    TriMesh mesh = tablet_in_envelope();
    // Places of the surface are those of its vertices: walls that are cut up finely.
    for (PartitionId id : {kTablet, kInside})
      for (int i = 0; i < 40; ++i)
        for (int k = 0; k < 40; ++k) {
          const float y = id == kTablet ? 0.0f : -1.0f;
          const auto first = static_cast<std::uint32_t>(mesh.positions.size());
          const float x = 0.5f * static_cast<float>(i), z = static_cast<float>(k);
          mesh.positions.insert(mesh.positions.end(), {{x, y, z}, {x + 0.5f, y, z}, {x, y, z + 1}});
          mesh.triangles.push_back({first, first + 1, first + 2});
          mesh.triangle_partition.push_back(id);
        }
    add_box(mesh, at - glm::vec3(0.1f), at + glm::vec3(0.1f), kPores);
    divide_pores(mesh);
    EXPECT_EQ(owner_of_last(mesh), owner) << at.y;
  }
}

TEST(PoresByBody, MeshesWithoutPoresOrBodiesStayAsTheyAre) {
  TriMesh mesh = tablet_in_envelope();
  const TriMesh before = mesh;
  divide_pores(mesh);
  EXPECT_EQ(mesh.triangle_partition, before.triangle_partition);
  EXPECT_EQ(mesh.partitions.size(), before.partitions.size());
  TriMesh alone;
  alone.partitions = {{.id = 0, .name = "pores and crumbs"}};
  add_box(alone, {0, 0, 0}, {1, 1, 1}, 0);
  divide_pores(alone);
  EXPECT_EQ(alone.partitions.find(PartitionKind::kPores)->within, "");
}

TEST(PoresByBody, InAFullTableTheLastRowIsShared) {
  TriMesh mesh;
  for (PartitionId id = 0; id < PartitionTable::kMost; ++id)
    ASSERT_TRUE(
        mesh.partitions.insert({.id = id, .name = id == kPores ? "pores and crumbs" : "body " + std::to_string(id)}));
  for (PartitionId id = 0; id < PartitionTable::kMost; ++id) {
    const float x = 10.0f * id;
    if (id == kPores) continue;
    add_box(mesh, {x, 0, 0}, {x + 5, 5, 5}, id);
    add_pore(mesh, {x + 2, 2, 2});
  }
  divide_pores(mesh);
  EXPECT_EQ(mesh.partitions.size(), PartitionTable::kMost);
  EXPECT_EQ(mesh.triangle_partition.back(), kPores);
}

}  // namespace
}  // namespace dubsar
