#pragma once
// Exact minimum s-t cut of a part of a lattice (Boykov and Kolmogorov 2004, as MinCut in core/parts for any graph): a
// point and the arcs to its six neighbours lie in one line of the cache, and most flow is sent in a wave before ways
// are looked for. Integer capacities, so that the result is the same everywhere.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/system/large_pages.h"

namespace dubsar {

class LatticeCut {
 public:
  /// `block` of each node, below `blocks`: flow inside each is found first, by all threads, before that between them
  /// (Liu and Sun 2010). `height` of each: flow mostly goes from the lowest to the highest, and what can go that way
  /// from neighbour to neighbour does so first. The cut is the same whatever they are.
  LatticeCut(std::vector<std::uint32_t> block, std::uint32_t blocks, const std::vector<float>& height);

  /// Cost of putting a node on either side; costs of several calls add up. Sums must stay below 2^30.
  /// Threads may add those of different nodes at the same time.
  void add_node_cost(std::uint32_t node, std::int32_t cost_if_source, std::int32_t cost_if_sink) {
    points_[place_[node]].terminal += cost_if_sink - cost_if_source;
  }
  /// Cost of separating neighbours, the same in both directions: `upper` is one step up the axis from `lower`; threads
  /// may add those of different pairs at the same time.
  void add_step_cost(std::uint32_t lower, std::uint32_t upper, std::uint32_t axis, std::int32_t cost);
  /// The same for any two nodes; meant for few of them.
  void tie(std::uint32_t a, std::uint32_t b, std::int32_t cost);

  /// Finds the cut, once. Nodes that fit either side equally well go to the sink side. Deterministic for any thread
  /// count. 68 bytes a node, and 8 until flow has gone up. kCancelled.
  Result<void> solve(Progress& progress);

  bool on_source_side(std::uint32_t node) const noexcept { return points_[place_[node]].label > 0; }

 private:
  static constexpr std::uint32_t kWays = 6;  ///< 2 axis: up it, 2 axis + 1: down
  static constexpr std::uint32_t kNone = 0xffffffffu, kTerminal = 0xfffffffeu, kOrphan = 0xfffffffdu;
  struct alignas(64) Point {
    std::int32_t terminal;    ///< > 0: from the source, < 0: to the sink
    std::int32_t label;       ///< on a tree: steps from the source, minus those to the sink, at some time; else 0
    std::uint32_t parent;     ///< arc to it: a way, or kWays + index of a tie
    std::uint32_t time : 30;  ///< when the label was right
    std::uint32_t active : 1, tied : 1;
    std::array<std::int32_t, kWays> residual;
    std::array<std::uint32_t, kWays> beside;
  };
  static constexpr Point kAlone{0, 0, kNone, 0, 0, 0, {}, {kNone, kNone, kNone, kNone, kNone, kNone}};
  struct Tie {
    std::uint32_t head, next;  ///< next of the same point; the sister is the other of the pair
    std::int32_t residual;
  };
  class Search;

  void add_tie(std::uint32_t from, std::uint32_t to, std::int32_t cost);
  void list_rising(std::uint32_t begin, std::uint32_t end);
  template <bool kSource>
  void wave(std::uint32_t begin, std::uint32_t end);
  /// The cut inside each range of points [starts[i], starts[i + 1]), by all threads: the first, or going on from
  /// smaller ranges. Leaves in `touched_` the points with arcs out of their range.
  void solve_ranges(const std::vector<std::uint32_t>& starts, bool first, Progress& progress);

  std::vector<std::uint32_t> place_;  ///< of each node: points stand block by block
  std::vector<std::uint32_t> first_;  ///< point of each block, and how many there are
  LargeArray<Point> points_;
  std::vector<float> height_;          ///< of each point, until flow has gone up
  std::vector<std::uint32_t> rising_;  ///< points of each block, layer by layer of their heights, as long
  std::vector<Tie> ties_;
  std::unordered_map<std::uint32_t, std::uint32_t> first_tie_;  ///< of the points that have some
  std::uint32_t time_ = 0;                                      ///< of the search so far
  std::vector<std::uint32_t> touched_;  ///< rising: points from which more may be reached than when the search ended
};

}  // namespace dubsar
