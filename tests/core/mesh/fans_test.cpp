#include "core/mesh/fans.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <vector>

namespace dubsar {
namespace {

TEST(Fans, CornersAreTogetherWhereTheClosureOfTheDefinitionJoinsThem) {
  std::mt19937 random(31);
  Fans fans;
  for (int round = 0; round < 400; ++round) {
    struct Corner {
      std::uint32_t next, previous;
    };
    std::vector<Corner> corners(random() % 14);
    fans.clear();
    for (Corner& c : corners) {
      c = {static_cast<std::uint32_t>(random() % 9), static_cast<std::uint32_t>(random() % 9)};
      fans.add(c.next, c.previous);
    }
    std::vector<std::size_t> expected(corners.size());
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    for (std::size_t n = 0; n < corners.size(); ++n)  // by plain repetition
      for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = 0; j < corners.size(); ++j)
          if (corners[i].next == corners[j].previous) expected[i] = expected[j] = std::min(expected[i], expected[j]);
    std::uint32_t count = 0;
    std::vector<std::uint32_t> number(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) number[i] = expected[i] == i ? count++ : number[expected[i]];
    ASSERT_EQ(fans.find(), count) << round;
    EXPECT_TRUE(std::equal(number.begin(), number.end(), fans.of_corner().begin())) << round;
  }
}

TEST(Fans, AClosedRingIsOneFanAndABowTieTwo) {
  Fans fans;
  for (std::uint32_t i = 0; i < 6; ++i) fans.add((i + 1) % 6, i);
  EXPECT_EQ(fans.find(), 1u);
  fans.clear();
  fans.add(1, 2);
  fans.add(8, 9);
  EXPECT_EQ(fans.find(), 2u);
  fans.clear();
  EXPECT_EQ(fans.find(), 0u);
}

}  // namespace
}  // namespace dubsar
