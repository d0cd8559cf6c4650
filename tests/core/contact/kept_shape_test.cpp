#include "core/contact/kept_shape.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/mesh/edge_uses.h"
#include "core/mesh/evidence.h"
#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

constexpr std::uint8_t kFilm = evidence_byte(Evidence::kFilm), kInferred = evidence_byte(Evidence::kInferred);

TEST(KeptShape, VerticesOfTheNextCutLieWhereTheyWereExceptWhereItStepsAside) {
  constexpr int kEdge = 20;
  const auto flat = [](int x, int y) { return glm::vec3(static_cast<float>(x), static_cast<float>(y), 7.5f); };
  const auto bump = [&](int x, int y) { return flat(x, y) + (x < 4 && y < 4 ? glm::vec3(0, 0, 2) : glm::vec3(0)); };
  const InterfaceMesh first = sheet(kEdge, flat);
  std::vector<glm::vec3> places = first.added;
  std::vector<std::uint8_t> evidence(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i].z += 0.01f * static_cast<float>(i);
    evidence[i] = i % 3 == 0 ? kFilm : kInferred;
  }
  InterfaceMesh next = sheet(kEdge, bump);
  const std::vector<glm::vec3> cut = next.added;
  const KeptShape::Known found = KeptShape(first.added, places, evidence, 0, {}).shape(next);
  int aside = 0;
  for (std::size_t i = 0; i < next.added.size(); ++i) {
    const bool same = cut[i] == first.added[i];
    aside += !same;
    EXPECT_EQ(next.added[i], same ? places[i] : cut[i]);
    EXPECT_EQ(found.evidence[i], same ? evidence[i] : kInferred);
    EXPECT_EQ(found.settled[i] != 0, same);
  }
  EXPECT_EQ(aside, 16);
}

TEST(KeptShape, VerticesOfOnePlaceKeepTheirOrder) {
  const glm::vec3 here(1.0f, 2.0f, 3.0f), there(4.0f, 4.0f, 4.0f);
  const std::vector<glm::vec3> cut{here, there, here}, places{{1, 2, 3.5f}, {4, 4, 5}, {1, 2, 2.5f}};
  const std::vector<std::uint8_t> evidence{kFilm, kInferred, kInferred};
  const KeptShape kept(cut, places, evidence, 0, {});
  InterfaceMesh next;
  next.added = {here, here, here, there};
  EXPECT_EQ(kept.shape(next).evidence, (std::vector<std::uint8_t>{kFilm, kInferred, kInferred, kInferred}));
  EXPECT_EQ(next.added, (std::vector<glm::vec3>{places[0], places[2], here, places[1]}));
}

TEST(KeptShape, EdgesAreSplitAgainWhereTheyAre) {
  constexpr int kEdge = 12;
  const auto id = [](int x, int y) { return static_cast<std::uint32_t>(y * kEdge + x); };
  const auto flat = [](int x, int y) { return glm::vec3(static_cast<float>(x), static_cast<float>(y), 7.5f); };
  const auto bump = [&](int x, int y) { return flat(x, y) + (x < 3 && y < 3 ? glm::vec3(0, 0, 2) : glm::vec3(0)); };
  const InterfaceMesh first = sheet(kEdge, flat);
  const auto count = static_cast<std::uint32_t>(first.added.size());
  // one edge, half of it once more, a diagonal, and an edge of what will have moved
  const std::vector<PatchSplit> splits{
      {id(6, 6), id(7, 6)}, {count, id(7, 6)}, {id(8, 8), id(9, 9)}, {id(1, 1), id(2, 1)}, {id(4, 4), id(5, 4)}};
  std::vector<glm::vec3> places = first.added;
  std::vector<std::uint8_t> evidence(places.size(), kFilm);
  for (const glm::vec3& p : {glm::vec3(6.5f, 6, 8), glm::vec3(6.75f, 6, 8), glm::vec3(8.5f, 8.5f, 8),
                             glm::vec3(1.5f, 1, 8), glm::vec3(4.5f, 4, 8)}) {
    places.push_back(p);
    evidence.push_back(kInferred);
  }
  InterfaceMesh next = sheet(kEdge, bump);
  const std::size_t triangles = next.triangles.size();
  const KeptShape::Known known = KeptShape(first.added, places, evidence, 0, splits).shape(next);
  ASSERT_EQ(next.added.size(), count + 4u) << "all but the one that is elsewhere";
  const std::vector<glm::vec3> tail(next.added.end() - 4, next.added.end());
  EXPECT_EQ(tail, (std::vector<glm::vec3>{places[count], places[count + 1], places[count + 2], places[count + 4]}));
  EXPECT_EQ(next.triangles.size(), triangles + 2 * 4);
  EXPECT_EQ(known.evidence.size(), next.added.size());
  EXPECT_EQ(known.evidence.back(), kInferred);
  EXPECT_EQ(known.settled.back(), 1);
  ASSERT_EQ(known.splits.size(), 4u);
  EXPECT_EQ(known.splits[1].a, count) << "ids of this mesh";
  EXPECT_EQ(next.strength.size(), next.added.size());

  glm::vec3 area(0.0f);  // of the sheet in the plane: nothing is missing or covered twice
  for (const Triangle& t : next.triangles) {
    const glm::vec3 n = glm::cross(next.added[t[1]] - next.added[t[0]], next.added[t[2]] - next.added[t[0]]);
    EXPECT_GT(n.z, 0.0f);
    area += n;
  }
  EXPECT_FLOAT_EQ(area.z, 2.0f * (kEdge - 1) * (kEdge - 1));
  std::size_t alone = 0;
  for (const bool side : sides_alone(next.triangles)) alone += side;
  EXPECT_EQ(alone, 4u * (kEdge - 1)) << "only the border of the sheet is open";
}

}  // namespace
}  // namespace dubsar
