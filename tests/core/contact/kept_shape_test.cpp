#include "core/contact/kept_shape.h"

#include <gtest/gtest.h>

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
  const std::vector<std::uint8_t> found = KeptShape(first.added, places, evidence).shape(next);
  int aside = 0;
  for (std::size_t i = 0; i < next.added.size(); ++i) {
    const bool same = cut[i] == first.added[i];
    aside += !same;
    EXPECT_EQ(next.added[i], same ? places[i] : cut[i]);
    EXPECT_EQ(found[i], same ? evidence[i] : kInferred);
  }
  EXPECT_EQ(aside, 16);
}

TEST(KeptShape, VerticesOfOnePlaceKeepTheirOrder) {
  const glm::vec3 here(1.0f, 2.0f, 3.0f), there(4.0f, 4.0f, 4.0f);
  const std::vector<glm::vec3> cut{here, there, here}, places{{1, 2, 3.5f}, {4, 4, 5}, {1, 2, 2.5f}};
  const std::vector<std::uint8_t> evidence{kFilm, kInferred, kInferred};
  const KeptShape kept(cut, places, evidence);
  InterfaceMesh next;
  next.added = {here, here, here, there};
  EXPECT_EQ(kept.shape(next), (std::vector<std::uint8_t>{kFilm, kInferred, kInferred, kInferred}));
  EXPECT_EQ(next.added, (std::vector<glm::vec3>{places[0], places[2], here, places[1]}));
}

}  // namespace
}  // namespace dubsar
