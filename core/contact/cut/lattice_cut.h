#pragma once
// Exact minimum s-t cut of a part of a lattice (Boykov and Kolmogorov 2004, as MinCut in core/parts for any graph):
// points lie in bricks and know their neighbours by their place, and most flow is sent in a wave before ways are looked
// for. Integer capacities, so that the result is the same everywhere.

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/cut/lattice_graph.h"

namespace dubsar {

class LatticeCut {
 public:
  /// Borrows the bricks. Those of block i are starts[i] to starts[i + 1], from starts[0] = 1 to how many there are:
  /// flow inside each block is found first, by all threads, before that between them (Liu and Sun 2010). The cut is the
  /// same whatever they are.
  LatticeCut(const LatticeBricks& bricks, std::vector<std::uint32_t> starts);

  /// What a point costs more on the sink side than on the source side; between -2^30 and 2^30. Threads may change those
  /// of different points at the same time.
  std::int32_t& wish(std::uint32_t point) noexcept { return graph_.points[point].terminal; }
  /// Cost of separating a point from the one a step up the axis, the same in both directions, at most kMostStep in all;
  /// both are in bricks. Threads may add those of different pairs at the same time.
  void add_step_cost(std::uint32_t point, std::uint32_t axis, std::int32_t cost);
  static constexpr std::int32_t kMostStep = (1 << 15) - 1;
  /// The same for any two points; meant for few of them.
  void tie(std::uint32_t a, std::uint32_t b, std::int32_t cost);
  /// Flow mostly goes from the lowest to the highest, and what can go that way from neighbour to neighbour does so
  /// first. The cut is the same whatever heights are.
  void set_height(std::uint32_t point, float height);

  /// Finds the cut, once. Points that fit either side equally well go to the sink side. Deterministic for any thread
  /// count. 28 bytes for each place of a brick. kCancelled.
  Result<void> solve(Progress& progress);

  bool on_source_side(std::uint32_t point) const noexcept { return graph_.points[point].label > 0; }

 private:
  using Graph = LatticeGraph;
  void add_tie(std::uint32_t from, std::uint32_t to, std::int32_t cost);
  /// The cut inside each range of bricks [starts[i], starts[i + 1]), by all threads: the first, or going on from
  /// smaller ranges. Leaves in `touched_` the points with arcs out of their range.
  void solve_ranges(const std::vector<std::uint32_t>& starts, bool first, Progress& progress);
  std::vector<std::uint32_t> points_with_arcs_out(std::uint32_t begin, std::uint32_t end) const;

  std::vector<std::uint32_t> starts_;
  Graph graph_;
  std::uint32_t time_ = 0;              ///< of the search so far
  std::vector<std::uint32_t> touched_;  ///< rising: points from which more may be reached than when the search ended
};

}  // namespace dubsar
