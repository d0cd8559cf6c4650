#include "core/base/numbers/disjoint_sets.h"

#include <gtest/gtest.h>

#include <random>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// The smallest item that a chain of pairs leads to, by plain repetition.
std::vector<std::uint32_t> closure(std::size_t count,
                                   const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
  std::vector<std::uint32_t> root(count);
  std::iota(root.begin(), root.end(), 0u);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : pairs) {
      const std::uint32_t least = std::min(root[a], root[b]);
      changed = changed || root[a] != least || root[b] != least;
      root[a] = root[b] = least;
    }
  }
  return root;
}

TEST(DisjointSets, RootsAreTheSmallestItemsOfTheClosure) {
  std::mt19937 random(8);
  for (const std::size_t count : {1u, 7u, 300u}) {
    for (int round = 0; round < 20; ++round) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(random() % (count + 1));
      for (auto& [a, b] : pairs)
        a = static_cast<std::uint32_t>(random() % count), b = static_cast<std::uint32_t>(random() % count);
      const std::vector<std::uint32_t> expected = closure(count, pairs);
      DisjointSets sets(count);
      std::size_t left = count;
      for (const auto& [a, b] : pairs) left -= sets.join(a, b);
      std::size_t roots = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(sets.root(i), expected[i]);
        roots += expected[i] == i;
      }
      EXPECT_EQ(left, roots);
    }
  }
}

TEST(ConcurrentSets, ManyThreadsFindTheRootsOfOne) {
  constexpr std::size_t kItems = 200'000;
  std::mt19937 random(9);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(kItems);
  for (auto& [a, b] : pairs)
    a = static_cast<std::uint32_t>(random() % kItems), b = static_cast<std::uint32_t>(random() % kItems);
  DisjointSets one(kItems);
  for (const auto& [a, b] : pairs) one.join(a, b);
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    ConcurrentSets many(kItems);
    parallel_for(static_cast<std::int64_t>(pairs.size()), 64, [&](std::int64_t i) {
      const auto& [a, b] = pairs[static_cast<std::size_t>(i)];
      many.join(a, b);
    });
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < kItems; ++i) wrong += many.root(i) != one.root(i);
    EXPECT_EQ(wrong, 0u) << threads << " threads";
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace dubsar
