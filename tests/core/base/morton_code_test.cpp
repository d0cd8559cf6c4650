#include "core/base/numbers/morton_code.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

TEST(MortonCode, BitsOfTheThreeAxesTakeTurns) {
  std::mt19937 random(std::random_device{}());
  std::uniform_int_distribution<std::uint32_t> any(0, (1u << 21) - 1);
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t x = any(random), y = any(random), z = any(random);
    std::uint64_t expected = 0;
    for (int bit = 0; bit < 21; ++bit)
      expected |= static_cast<std::uint64_t>((x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2) << (3 * bit);
    EXPECT_EQ(morton_code(glm::vec3(x, y, z)), expected) << x << " " << y << " " << z;
  }
}

}  // namespace
}  // namespace dubsar
