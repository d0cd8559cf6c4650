#include "core/contact/cut/lattice_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <compare>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/parts/min_cut.h"

namespace dubsar {
namespace {

/// Points on the source's side of the least of all minimum cuts, by Edmonds and Karp on a matrix of capacities.
std::vector<bool> least_source_side(std::uint32_t nodes, std::vector<std::vector<std::int64_t>> left) {
  const std::uint32_t source = nodes, sink = nodes + 1, none = nodes + 2;
  for (;;) {
    std::vector<std::uint32_t> from(nodes + 2, none), queue{source};
    from[source] = source;
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (std::uint32_t m = 0; m < nodes + 2; ++m)
        if (from[m] == none && left[queue[i]][m] > 0) {
          from[m] = queue[i];
          queue.push_back(m);
        }
    if (from[sink] == none) {
      std::vector<bool> side(nodes);
      for (std::uint32_t n = 0; n < nodes; ++n) side[n] = from[n] != none;
      return side;
    }
    std::int64_t flow = INT64_MAX;
    for (std::uint32_t m = sink; m != source; m = from[m]) flow = std::min(flow, left[from[m]][m]);
    for (std::uint32_t m = sink; m != source; m = from[m]) {
      left[from[m]][m] -= flow;
      left[m][from[m]] += flow;
    }
  }
}

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
  std::uint32_t box;  ///< its edge
  std::vector<glm::ivec3> position;
  std::vector<std::int32_t> wish;  ///< > 0: the source's
  std::vector<Step> steps;
  std::vector<Tie> ties;
  std::vector<float> height;

  Problem(unsigned seed, std::uint32_t edge, int most_step, int most_wish) : box(edge) {
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
          position.emplace_back(x, y, z);
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
  std::vector<bool> sides_of_matrix() const {
    std::vector<std::vector<std::int64_t>> left(nodes + 2, std::vector<std::int64_t>(nodes + 2, 0));
    const auto join = [&](std::uint32_t a, std::uint32_t b, std::int64_t cost) {
      left[a][b] += cost;
      left[b][a] += cost;
    };
    for (std::uint32_t n = 0; n < nodes; ++n) (wish[n] > 0 ? left[nodes][n] : left[n][nodes + 1]) = std::abs(wish[n]);
    for (const Step& step : steps) join(step.lower, step.upper, step.cost);
    for (const Tie& tie : ties) join(tie.a, tie.b, tie.cost);
    return least_source_side(nodes, std::move(left));
  }
  std::vector<bool> sides_of_lattice(std::uint32_t blocks, Progress& progress, bool* cancelled = nullptr) const {
    struct Brick {
      std::uint32_t block;
      std::array<std::int32_t, 3> place;
      auto operator<=>(const Brick&) const = default;
    };
    std::vector<Brick> found;
    for (const glm::ivec3& p : position)
      found.push_back({static_cast<std::uint32_t>(p.x / 4 + p.y / 8) % blocks, {p.x / 4, p.y / 4, p.z / 4}});
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::vector<glm::ivec3> places;
    std::vector<std::uint32_t> starts;
    for (std::uint32_t i = 0; i < found.size(); ++i) {
      if (i == 0 || found[i].block != found[i - 1].block) starts.push_back(i + 1);
      places.emplace_back(found[i].place[0], found[i].place[1], found[i].place[2]);
    }
    starts.push_back(static_cast<std::uint32_t>(found.size() + 1));
    const LatticeBricks bricks({box, box, box}, places);
    LatticeCut cut(bricks, starts);
    const auto point = [&](std::uint32_t n) { return bricks.at(position[n]); };
    for (std::uint32_t n = 0; n < nodes; ++n) {
      cut.wish(point(n)) = wish[n];
      cut.set_height(point(n), height[n]);
    }
    for (const Step& step : steps) cut.add_step_cost(point(step.lower), step.axis, step.cost);
    for (const Tie& tie : ties) cut.tie(point(tie.a), point(tie.b), tie.cost);
    const auto solved = cut.solve(progress);
    EXPECT_EQ(solved.has_value(), cancelled == nullptr);
    if (cancelled != nullptr) *cancelled = !solved && solved.error().kind == ErrorKind::kCancelled;
    std::vector<bool> source(nodes);
    for (std::uint32_t n = 0; n < nodes; ++n) source[n] = cut.on_source_side(point(n));
    return source;
  }
  std::vector<bool> sides_of_lattice(std::uint32_t blocks) const {
    SilentProgress progress;
    return sides_of_lattice(blocks, progress);
  }
};

class LatticeCuts : public testing::TestWithParam<unsigned> {};

TEST_P(LatticeCuts, HaveTheSidesOfTheSameGraphWhateverTheBlocks) {
  const unsigned seed = GetParam();
  const Problem problem(seed, 4 + seed % 14, 2 + static_cast<int>(seed * 7 % 40), 1 + static_cast<int>(seed % 5));
  const std::vector<bool> sides = problem.sides_of_graph();
  const auto tablet = std::count(sides.begin(), sides.end(), true);
  EXPECT_GT(tablet, 0);
  EXPECT_LT(tablet, static_cast<std::ptrdiff_t>(sides.size()));
  for (const std::uint32_t blocks : {1u, 2u, 7u})
    ASSERT_EQ(problem.sides_of_lattice(blocks), sides) << blocks << " blocks, seed " << seed;
}

TEST_P(LatticeCuts, GiveTheSinkWhatFitsEitherSide) {
  const unsigned seed = 5000 + GetParam();
  const Problem problem(seed, 3 + seed % 4, 2 + static_cast<int>(seed % 6), 1 + static_cast<int>(seed % 3));
  for (const std::uint32_t blocks : {1u, 3u})
    ASSERT_EQ(problem.sides_of_lattice(blocks), problem.sides_of_matrix()) << blocks << " blocks, seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(Drawn, LatticeCuts, testing::Range(1u, 61u));

TEST(LatticeCut, OneTwoAndSevenThreadsGiveTheSameSides) {
  const Problem problem(77, 24, 9, 3);
  std::vector<bool> sides;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    const std::vector<bool> found = problem.sides_of_lattice(7);
    if (sides.empty()) sides = found;
    EXPECT_EQ(found, sides) << threads;
  }
  set_thread_count(0);
}

/// Labels count to 32,767.
TEST(LatticeCut, FindsTheNarrowestPlaceOfAWayOf40000Steps) {
  constexpr std::int32_t kLong = 40000, kNarrow = 31234;
  std::vector<glm::ivec3> places;
  for (std::int32_t b = 0; b < kLong / 4; ++b) places.emplace_back(b, 0, 0);
  const LatticeBricks bricks({kLong, 1, 1}, places);
  LatticeCut cut(bricks, {1, bricks.count()});
  for (std::int32_t x = 0; x + 1 < kLong; ++x) cut.add_step_cost(bricks.at({x, 0, 0}), 0, x == kNarrow ? 3 : 4 + x % 5);
  cut.wish(bricks.at({0, 0, 0})) = 1 << 28;
  cut.wish(bricks.at({kLong - 1, 0, 0})) = -(1 << 28);
  SilentProgress progress;
  ASSERT_TRUE(cut.solve(progress).has_value());
  for (std::int32_t x = 0; x < kLong; ++x) ASSERT_EQ(cut.on_source_side(bricks.at({x, 0, 0})), x <= kNarrow) << x;
}

TEST(LatticeCut, StopsWhenCancelled) {
  const Problem problem(78, 12, 9, 3);
  SilentProgress progress;
  progress.cancel();
  bool cancelled = false;
  problem.sides_of_lattice(3, progress, &cancelled);
  EXPECT_TRUE(cancelled);
}

}  // namespace
}  // namespace dubsar
