#pragma once
// Exact minimum s-t cut of a sparse graph (Boykov and Kolmogorov 2004: two search trees that are kept between
// augmentations). Integer capacities, so that the result is the same everywhere.

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace dubsar {

class MinCut {
 public:
  explicit MinCut(std::uint32_t nodes) : terminal_(nodes, 0) {}

  /// Cost of putting a node on either side; costs of several calls add up. Sums must stay below 2^30.
  void add_node_cost(std::uint32_t node, std::int32_t cost_if_source, std::int32_t cost_if_sink) {
    terminal_[node] += cost_if_sink - cost_if_source;
  }
  /// Cost of separating a and b, the same in both directions. Parallel edges are allowed.
  void add_edge(std::uint32_t a, std::uint32_t b, std::int32_t cost) {
    if (cost > 0 && a != b) edges_.push_back({a, b, cost});
  }
  /// Blocks of nodes: flow inside each is found first, by all threads, before that between them (Liu and Sun 2010). The
  /// cut is the same without. `block`: of each node; `blocks`: how many there are.
  void set_blocks(std::vector<std::uint32_t> block, std::uint32_t blocks) {
    block_ = std::move(block);
    blocks_ = blocks;
  }

  /// Finds the cut. Nodes that fit either side equally well go to the sink side. Deterministic for any thread count.
  /// Worst case polynomial of high degree, on surfaces close to linear. kCancelled.
  Result<void> solve(Progress& progress);

  bool on_source_side(std::uint32_t node) const noexcept { return tree_[node] == kSource; }

 private:
  enum Tree : std::uint8_t { kFree, kSource, kSink };
  static constexpr std::uint32_t kNone = 0xffffffffu, kTerminal = 0xfffffffeu, kOrphan = 0xfffffffdu;
  struct Edge {
    std::uint32_t a, b;
    std::int32_t cost;
  };
  struct Arc {
    std::uint32_t head, sister;
    std::int32_t residual;
  };
  template <bool kInBlock>
  class Search;

  void build();
  std::vector<std::int32_t> terminal_;  ///< > 0: from the source, < 0: to the sink
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> block_;
  std::uint32_t blocks_ = 0;
  std::vector<std::uint32_t> first_arc_;
  std::vector<Arc> arcs_;
  std::vector<std::uint32_t> parent_;  ///< arc to the parent, or kNone, kTerminal, kOrphan
  std::vector<std::uint8_t> tree_;
  std::vector<std::uint32_t> distance_, stamp_;
  std::vector<std::uint8_t> active_;
};

}  // namespace dubsar
