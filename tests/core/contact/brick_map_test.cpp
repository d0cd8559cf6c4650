#include "core/contact/brick_map.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace dubsar {
namespace {

TEST(BrickMap, HoldsWhatWasWrittenAndNothingElse) {
  const Dims dims{37, 20, 51};
  BrickMap<int> map(dims, -7);
  std::map<std::array<std::int64_t, 3>, int> expected;
  std::mt19937 random(31);
  for (int i = 0; i < 500; ++i) {
    const std::array<std::int64_t, 3> p{std::uniform_int_distribution<std::int64_t>(0, 36)(random),
                                        std::uniform_int_distribution<std::int64_t>(0, 19)(random),
                                        std::uniform_int_distribution<std::int64_t>(0, 50)(random)};
    map.at(p[0], p[1], p[2]) = i;
    expected[p] = i;
  }
  for (std::int64_t z = -2; z < dims.z + 2; ++z)
    for (std::int64_t y = -2; y < dims.y + 2; ++y)
      for (std::int64_t x = -2; x < dims.x + 2; ++x) {
        const auto known = expected.find({x, y, z});
        ASSERT_EQ(map.get(x, y, z), known == expected.end() ? -7 : known->second);
      }
}

TEST(BrickMap, BricksAreMadeWhereSomebodyWrites) {
  BrickMap<float> map({64, 64, 64}, 0.0f);
  map.at(17, 8, 63) = 1.0f;
  int bricks = 0;
  for (std::int64_t z = 0; z < 8; ++z)
    for (std::int64_t y = 0; y < 8; ++y)
      for (std::int64_t x = 0; x < 8; ++x) bricks += map.has_brick(x, y, z);
  EXPECT_EQ(bricks, 1);
  EXPECT_TRUE(map.has_brick(2, 1, 7));
}

TEST(BrickMap, ABrickHasItsPointsAlongXThenYThenZ) {
  BrickMap<int> map({21, 17, 30}, -1);
  map.reserve(2);
  map.add_brick(2, 1, 3);
  map.at(20, 11, 29) = 5;
  map.brick(2, 1, 3)[(1 * 8 + 7) * 8 + 3] = 6;
  EXPECT_EQ(map.brick(2, 1, 3)[(5 * 8 + 3) * 8 + 4], 5);
  EXPECT_EQ(map.get(19, 15, 25), 6);
  EXPECT_EQ(map.brick(2, 1, 3)[5], -1);  // beyond the grid
  EXPECT_EQ(map.brick(0, 0, 0), nullptr);
  EXPECT_EQ(map.brick(-1, 0, 0), nullptr);
  EXPECT_EQ(map.brick(3, 1, 3), nullptr);
}

}  // namespace
}  // namespace dubsar
