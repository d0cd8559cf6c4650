#include "core/contact/lattice_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/parts/min_cut.h"

namespace dubsar {
namespace {

/// A box of lattice points with holes, costs that are small, so that many cuts are equally cheap, and a few ties.
struct Problem {
  struct Step {
    std::uint32_t lower, upper, axis;
    std::int32_t cost;
  };
  struct Tie {
    std::uint32_t a, b;
    std::int32_t cost;
  };
  std::uint32_t nodes = 0;
  std::vector<std::int32_t> wish;  ///< > 0: the source's
  std::vector<Step> steps;
  std::vector<Tie> ties;
  std::vector<std::uint32_t> block;
  std::vector<float> height;

  Problem(unsigned seed, std::uint32_t edge, int most_step, int most_wish, std::uint32_t blocks) {
    std::mt19937 random(seed);
    const auto draw = [&](int n) { return static_cast<std::int32_t>(random() % static_cast<unsigned>(n)); };
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> node(edge * edge * edge, kNone);
    const auto at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) -> std::uint32_t& {
      return node[(z * edge + y) * edge + x];
    };
    for (std::uint32_t z = 0; z < edge; ++z)
      for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) {
          if (draw(12) == 0) continue;
          at(x, y, z) = nodes++;
          wish.push_back(z == 0 ? 1 << 28 : z + 1 == edge ? -(1 << 28) : draw(2 * most_wish + 1) - most_wish);
          block.push_back((x / 4 + y / 5) % blocks);
          height.push_back(seed % 3 == 0 ? static_cast<float>(draw(5)) : static_cast<float>(z));
        }
    for (std::uint32_t z = 0; z < edge; ++z)
      for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) {
          const std::uint32_t n = at(x, y, z);
          const auto step = [&](bool there, std::uint32_t dx, std::uint32_t dy, std::uint32_t dz, std::uint32_t axis) {
            if (there && n != kNone && at(x + dx, y + dy, z + dz) != kNone)
              steps.push_back({n, at(x + dx, y + dy, z + dz), axis, draw(most_step)});
          };
          step(x + 1 < edge, 1, 0, 0, 0);
          step(y + 1 < edge, 0, 1, 0, 1);
          step(z + 1 < edge, 0, 0, 1, 2);
        }
    const auto any_node = [&] { return static_cast<std::uint32_t>(random() % nodes); };
    for (int k = 0; k < 6; ++k) ties.push_back({any_node(), any_node(), k % 2 == 0 ? 1 << 28 : 1 + draw(most_step)});
    ties.erase(std::remove_if(ties.begin(), ties.end(), [](const Tie& tie) { return tie.a == tie.b; }), ties.end());
  }

  /// As a graph that is no lattice.
  std::vector<bool> sides_of_graph() const {
    MinCut cut(nodes);
    for (std::uint32_t n = 0; n < nodes; ++n) cut.add_node_cost(n, std::max(-wish[n], 0), std::max(wish[n], 0));
    for (const Step& step : steps) cut.add_edge(step.lower, step.upper, step.cost);
    for (const Tie& tie : ties) cut.add_edge(tie.a, tie.b, tie.cost);
    SilentProgress progress;
    EXPECT_TRUE(cut.solve(progress).has_value());
    std::vector<bool> source(nodes);
    for (std::uint32_t n = 0; n < nodes; ++n) source[n] = cut.on_source_side(n);
    return source;
  }
  LatticeCut lattice(std::uint32_t blocks) const {
    std::vector<std::uint32_t> in = block;
    for (std::uint32_t& b : in) b %= blocks;
    LatticeCut cut(in, blocks, height);
    for (std::uint32_t n = 0; n < nodes; ++n) cut.add_node_cost(n, std::max(-wish[n], 0), std::max(wish[n], 0));
    for (const Step& step : steps) cut.add_step_cost(step.lower, step.upper, step.axis, step.cost);
    for (const Tie& tie : ties) cut.tie(tie.a, tie.b, tie.cost);
    return cut;
  }
  std::vector<bool> solved(LatticeCut& cut) const {
    SilentProgress progress;
    EXPECT_TRUE(cut.solve(progress).has_value());
    std::vector<bool> source(nodes);
    for (std::uint32_t n = 0; n < nodes; ++n) source[n] = cut.on_source_side(n);
    return source;
  }
};

class LatticeCuts : public testing::TestWithParam<unsigned> {};

TEST_P(LatticeCuts, HaveTheSidesOfTheSameGraphWhateverTheBlocks) {
  const unsigned seed = GetParam();
  const Problem problem(seed, 4 + seed % 14, 2 + static_cast<int>(seed * 7 % 40), 1 + static_cast<int>(seed % 5), 7);
  const std::vector<bool> sides = problem.sides_of_graph();
  const auto tablet = std::count(sides.begin(), sides.end(), true);
  EXPECT_GT(tablet, 0);
  EXPECT_LT(tablet, static_cast<std::ptrdiff_t>(sides.size()));
  for (const std::uint32_t blocks : {1u, 2u, 7u}) {
    LatticeCut cut = problem.lattice(blocks);
    ASSERT_EQ(problem.solved(cut), sides) << blocks << " blocks, seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Drawn, LatticeCuts, testing::Range(1u, 61u));

TEST(LatticeCut, OneTwoAndSevenThreadsGiveTheSameSides) {
  const Problem problem(77, 24, 9, 3, 7);
  std::vector<bool> sides;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    LatticeCut cut = problem.lattice(7);
    const std::vector<bool> found = problem.solved(cut);
    if (sides.empty()) sides = found;
    EXPECT_EQ(found, sides) << threads;
  }
  set_thread_count(0);
}

TEST(LatticeCut, StopsWhenCancelled) {
  const Problem problem(78, 12, 9, 3, 3);
  LatticeCut cut = problem.lattice(3);
  SilentProgress progress;
  progress.cancel();
  const auto solved = cut.solve(progress);
  ASSERT_FALSE(solved);
  EXPECT_EQ(solved.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
