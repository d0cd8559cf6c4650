#include "core/volume/brick_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace dubsar {
namespace {

TEST(BrickMask, SpansAreThePointsWithinReachOfAMarkedBrick) {
  std::mt19937_64 random(4117);
  for (const Dims dims : {Dims{70, 20, 11}, Dims{8, 8, 8}, Dims{1, 9, 30}, Dims{530, 3, 2}}) {
    BrickMask mask(dims);
    const Dims b = mask.bricks();
    for (std::int64_t k = 0; k < 1 + b.count() / 9; ++k)
      mask.set(static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(b.x)),
               static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(b.y)),
               static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(b.z)));
    for (const std::int64_t reach : {0, 1, 5, 11}) {
      const auto wanted = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        for (std::int64_t bz = 0; bz < b.z; ++bz)
          for (std::int64_t by = 0; by < b.y; ++by)
            for (std::int64_t bx = 0; bx < b.x; ++bx) {
              const auto off = [&](std::int64_t p, std::int64_t brick) {
                return std::max<std::int64_t>({8 * brick - p, p - (8 * brick + 7), 0});
              };
              if (mask.get(bx, by, bz) && std::max({off(x, bx), off(y, by), off(z, bz)}) <= reach) return true;
            }
        return false;
      };
      std::vector<Span> spans;
      for (std::int64_t z = 0; z < dims.z; ++z) {
        bool any = false;
        for (std::int64_t y = 0; y < dims.y; ++y) {
          mask.spans(y, z, reach, spans);
          std::vector<Span> expected;
          for (std::int64_t x = 0; x < dims.x; ++x) {
            if (!wanted(x, y, z)) continue;
            if (expected.empty() || expected.back().end != x) expected.push_back({x, x});
            ++expected.back().end;
          }
          ASSERT_EQ(spans, expected) << dims.x << " reach " << reach << " row " << y << ' ' << z;
          any |= !expected.empty();
        }
        ASSERT_EQ(mask.any(z, z + 1, reach), any) << "slice " << z;
      }
    }
  }
}

TEST(BrickMask, AllBricksAreTheWholeGrid) {
  BrickMask mask({65 * 8 + 1, 9, 17});
  EXPECT_EQ(mask.count(), 0);
  mask.set_all();
  EXPECT_EQ(mask.count(), 66 * 2 * 3);
  std::vector<Span> spans;
  mask.spans(8, 16, 0, spans);
  EXPECT_EQ(spans, (std::vector<Span>{{0, 65 * 8 + 1}}));
}

}  // namespace
}  // namespace dubsar
