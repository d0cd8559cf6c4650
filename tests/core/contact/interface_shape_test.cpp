#include "core/contact/interface_shape.h"

#include <gtest/gtest.h>

#include "core/mesh/evidence.h"
#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

TEST(ShapeInterface, NothingMovesWhereMovingMadeItCross) {
  constexpr int kStairsEdge = 33;
  const FilmScene scene;
  const BandDensity density = scene.density();
  const InterfaceMesh stairs = sheet(kStairsEdge, [](int x, int y) {
    return glm::vec3(static_cast<float>(x), static_cast<float>(y), (x / 2 + y / 3) % 2 == 0 ? 20.0f : 21.0f);
  });
  const glm::vec3 place(16.0f, 16.0f, 20.5f);
  InterfaceMesh free = stairs, tied = stairs;
  shape_interface(free, {}, density, {}, {});
  const std::vector<std::uint8_t> evidence = shape_interface(tied, {}, density, {place}, {});
  int near = 0, smoothed = 0;
  for (std::size_t i = 0; i < tied.added.size(); ++i) {
    EXPECT_EQ(evidence[i], evidence_byte(Evidence::kInferred));
    const float away = glm::distance(stairs.added[i], place), moved = glm::distance(tied.added[i], stairs.added[i]);
    if (away < 3.0f) {
      ++near;
      EXPECT_EQ(moved, 0.0f);
      smoothed += free.added[i] != stairs.added[i];
    }
    EXPECT_LE(moved, 1.5f * std::clamp((away - 3.0f) / 4.0f, 0.0f, 1.0f) + 1e-5f);
  }
  EXPECT_GT(near, 20);
  EXPECT_EQ(smoothed, near) << "without the crossing all of them move";
}

}  // namespace
}  // namespace dubsar
