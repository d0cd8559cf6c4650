#include "core/parts/min_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace dubsar {
namespace {

struct Problem {
  std::vector<std::pair<int, int>> node_costs;  ///< if source, if sink
  struct Edge {
    std::uint32_t a, b;
    int cost;
  };
  std::vector<Edge> edges;

  template <class OnSource>
  std::int64_t cost(const OnSource& on_source) const {
    std::int64_t sum = 0;
    for (std::uint32_t i = 0; i < node_costs.size(); ++i)
      sum += on_source(i) ? node_costs[i].first : node_costs[i].second;
    for (const Edge& e : edges) sum += on_source(e.a) != on_source(e.b) ? e.cost : 0;
    return sum;
  }
  std::int64_t cut_cost() const {
    MinCut cut(static_cast<std::uint32_t>(node_costs.size()));
    for (std::uint32_t i = 0; i < node_costs.size(); ++i)
      cut.add_node_cost(i, node_costs[i].first, node_costs[i].second);
    for (const Edge& e : edges) cut.add_edge(e.a, e.b, e.cost);
    SilentProgress progress;
    EXPECT_TRUE(cut.solve(progress).has_value());
    return cost([&](std::uint32_t i) { return cut.on_source_side(i); });
  }
};

TEST(MinCut, NoLabellingOfSmallGraphsIsCheaper) {
  std::mt19937 random(7);
  const auto draw = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int trial = 0; trial < 400; ++trial) {
    const std::uint32_t nodes = 2 + static_cast<std::uint32_t>(draw(11));
    Problem problem;
    for (std::uint32_t i = 0; i < nodes; ++i) problem.node_costs.emplace_back(draw(12), draw(12));
    for (int e = draw(30); e > 0; --e)
      problem.edges.push_back({static_cast<std::uint32_t>(draw(static_cast<int>(nodes))),
                               static_cast<std::uint32_t>(draw(static_cast<int>(nodes))), draw(9)});
    std::int64_t best = std::numeric_limits<std::int64_t>::max();
    for (std::uint32_t bits = 0; bits < 1u << nodes; ++bits)
      best = std::min(best, problem.cost([&](std::uint32_t i) { return (bits >> i & 1u) != 0; }));
    ASSERT_EQ(problem.cut_cost(), best) << "trial " << trial;
  }
}

/// On a line of n nodes a dynamic programme gives the exact answer for any n.
TEST(MinCut, LongChainsAgreeWithDynamicProgramming) {
  std::mt19937 random(11);
  Problem problem;
  std::int64_t source = 0, sink = 0;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const int as_source = static_cast<int>(random() % 100), as_sink = static_cast<int>(random() % 100);
    problem.node_costs.emplace_back(as_source, as_sink);
    int link = 0;
    if (i > 0) {
      link = static_cast<int>(random() % 80);
      problem.edges.push_back({i - 1, i, link});
    }
    const std::int64_t s = std::min(source, sink + link) + as_source, t = std::min(sink, source + link) + as_sink;
    source = i == 0 ? as_source : s;
    sink = i == 0 ? as_sink : t;
  }
  EXPECT_EQ(problem.cut_cost(), std::min(source, sink));
}

TEST(MinCut, GridIsCutAtItsCheapestColumn) {
  constexpr std::uint32_t kSide = 300;
  MinCut cut(kSide * kSide);
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t i = y * kSide + x;
      if (x == 0) cut.add_node_cost(i, 0, 1000);
      if (x == kSide - 1) cut.add_node_cost(i, 1000, 0);
      if (x + 1 < kSide) cut.add_edge(i, i + 1, x == 123 ? 5 : 6);
      if (y + 1 < kSide) cut.add_edge(i, i + kSide, 6);
    }
  SilentProgress progress;
  ASSERT_TRUE(cut.solve(progress).has_value());
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) ASSERT_EQ(cut.on_source_side(i), i % kSide <= 123);
}

/// Costs are small, so that many cuts are equally cheap: the sides are still the same.
TEST(MinCut, BlocksOfNodesDoNotChangeTheSides) {
  constexpr std::uint32_t kEdge = 24, kNodes = kEdge * kEdge * kEdge;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto sides = [&](std::uint32_t blocks) {
      std::mt19937 random(seed);
      MinCut cut(kNodes);
      for (std::uint32_t n = 0; n < kNodes; ++n) {
        const std::uint32_t x = n % kEdge, y = n / kEdge % kEdge, z = n / (kEdge * kEdge);
        cut.add_node_cost(n, z == 0 ? 0 : static_cast<int>(random() % 6), z == kEdge - 1 ? 0 : z == 0 ? 1000 : 2);
        if (x + 1 < kEdge) cut.add_edge(n, n + 1, static_cast<int>(random() % 5));
        if (y + 1 < kEdge) cut.add_edge(n, n + kEdge, static_cast<int>(random() % 5));
        if (z + 1 < kEdge) cut.add_edge(n, n + kEdge * kEdge, static_cast<int>(random() % 7));
      }
      if (blocks > 0) {
        std::vector<std::uint32_t> block(kNodes);
        for (std::uint32_t n = 0; n < kNodes; ++n) block[n] = n % kEdge / 8 % blocks;
        cut.set_blocks(std::move(block), blocks);
      }
      SilentProgress progress;
      EXPECT_TRUE(cut.solve(progress).has_value());
      std::vector<bool> source(kNodes);
      for (std::uint32_t n = 0; n < kNodes; ++n) source[n] = cut.on_source_side(n);
      return source;
    };
    const std::vector<bool> whole = sides(0);
    EXPECT_GT(std::count(whole.begin(), whole.end(), true), kNodes / 20);
    EXPECT_LT(std::count(whole.begin(), whole.end(), true), kNodes - kNodes / 20);
    for (const std::uint32_t blocks : {1u, 2u, 3u}) EXPECT_EQ(sides(blocks), whole) << blocks << ", seed " << seed;
  }
}

}  // namespace
}  // namespace dubsar
