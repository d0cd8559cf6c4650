// What is known around a vertex, against the plain walk that the specification describes.

#include "core/exa/values/known_levels.h"

#include <gtest/gtest.h>

#include <random>

#include "core/exa/values/vertex_order.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {

TEST(LevelsAround, AreThoseOfTheKnownSurroundings) {
  std::size_t doubled = 0, met = 0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const QuadMesh mesh = sample_model({24, 22, 20}, Kind::kNoise, seed).mesh;
    doubled += mesh.doubled.size();
    std::mt19937 random(seed);
    std::vector<std::uint8_t> values(static_cast<std::size_t>(mesh.vertex_count()));
    // A part of the vertices, as of a chunk: those before and behind are never known.
    const std::uint32_t first = 500, end = static_cast<std::uint32_t>(mesh.vertex_count()) - 300;
    LevelsAround levels(first, end);
    for (std::uint32_t v = first; v < end; ++v) {
      KnownLevels expected;
      known_surroundings(mesh, v, first, [&](std::uint32_t w, int share) {
        expected.sum += share * values[w];
        expected.shares += share;
        expected.lowest = std::min<int>(expected.lowest, values[w]);
        expected.highest = std::max<int>(expected.highest, values[w]);
      });
      const KnownLevels found = levels.of(mesh, v);
      ASSERT_EQ(found.sum, expected.sum) << v;
      ASSERT_EQ(found.shares, expected.shares) << v;
      ASSERT_EQ(found.highest, expected.highest) << v;
      ASSERT_EQ(found.lowest, expected.lowest) << v;
      met += expected.shares > 0 ? 1 : 0;
      values[v] = static_cast<std::uint8_t>(random() % 64);
      levels.set(v, values[v]);
    }
  }
  EXPECT_GT(doubled, 50u);
  EXPECT_GT(met, 1000u);
}

TEST(KnownLevels, TheMeanIsTheRoundedDivision) {
  for (int shares = 1; shares <= 100; ++shares)
    for (int sum = 0; sum <= 63 * shares; ++sum)
      ASSERT_EQ((KnownLevels{sum, shares, 0, 63}.mean()), (sum + shares / 2) / shares) << sum << " of " << shares;
}

}  // namespace
}  // namespace dubsar
