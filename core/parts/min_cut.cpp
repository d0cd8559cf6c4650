#include "core/parts/min_cut.h"

#include <algorithm>

#include "core/base/system/parallel.h"

namespace dubsar {

void MinCut::build() {
  const std::size_t nodes = terminal_.size();
  first_arc_.assign(nodes + 1, 0);
  for (const Edge& e : edges_) {
    ++first_arc_[e.a + 1];
    ++first_arc_[e.b + 1];
  }
  for (std::size_t i = 0; i < nodes; ++i) first_arc_[i + 1] += first_arc_[i];
  arcs_.resize(2 * edges_.size());
  std::vector<std::uint32_t> fill(first_arc_.begin(), first_arc_.end() - 1);
  for (const Edge& e : edges_) {
    const std::uint32_t ab = fill[e.a]++, ba = fill[e.b]++;
    arcs_[ab] = {e.b, ba, e.cost};
    arcs_[ba] = {e.a, ab, e.cost};
  }
  edges_ = {};
  parent_.assign(nodes, kNone);
  tree_.assign(nodes, kFree);
  distance_.assign(nodes, 0);
  stamp_.assign(nodes, 0);
  active_.assign(nodes, 0);
  for (std::uint32_t i = 0; i < nodes; ++i) {
    if (terminal_[i] == 0) continue;
    tree_[i] = terminal_[i] > 0 ? kSource : kSink;
    parent_[i] = kTerminal;
    distance_[i] = 1;
  }
}

/// Growing, augmenting and adopting from a queue of active nodes; `kInBlock`: of one block, whose arcs to other blocks
/// do not exist for it.
template <bool kInBlock>
class MinCut::Search {
 public:
  Search(MinCut& cut, std::uint32_t block, std::uint32_t time)
      : terminal_(cut.terminal_),
        block_of_(cut.block_),
        first_arc_(cut.first_arc_),
        arcs_(cut.arcs_),
        parent_(cut.parent_),
        tree_(cut.tree_),
        distance_(cut.distance_),
        stamp_(cut.stamp_),
        active_(cut.active_),
        block_(block),
        time_(time) {}

  void activate(std::uint32_t node) {
    if (active_[node]) return;
    active_[node] = 1;
    queue_.push_back(node);
  }
  /// False: cancelled.
  bool run(Progress& progress);
  std::uint32_t time() const noexcept { return time_; }

 private:
  std::uint32_t grow(std::uint32_t node);
  void augment(std::uint32_t middle);
  void make_orphan(std::uint32_t node);
  void adopt(std::uint32_t orphan);
  bool reaches_terminal(std::uint32_t node, std::uint32_t& distance) const;
  void mark_path(std::uint32_t node, std::uint32_t distance);
  bool elsewhere(std::uint32_t node) const { return kInBlock && block_of_[node] != block_; }
  std::int32_t residual_from(Tree tree, std::uint32_t arc) const {
    return tree == kSource ? arcs_[arc].residual : arcs_[arcs_[arc].sister].residual;
  }

  std::vector<std::int32_t>& terminal_;
  const std::vector<std::uint32_t>&block_of_, &first_arc_;
  std::vector<Arc>& arcs_;
  std::vector<std::uint32_t>& parent_;
  std::vector<std::uint8_t>& tree_;
  std::vector<std::uint32_t>&distance_, &stamp_;
  std::vector<std::uint8_t>& active_;
  std::vector<std::uint32_t> queue_, orphans_;
  std::size_t queue_head_ = 0;
  std::uint32_t block_, time_;
};

/// Looks for an arc from the source tree to the sink tree around an active node, and adds free neighbours to
/// its tree.
template <bool kInBlock>
std::uint32_t MinCut::Search<kInBlock>::grow(std::uint32_t node) {
  const Tree tree = static_cast<Tree>(tree_[node]);
  for (std::uint32_t a = first_arc_[node]; a < first_arc_[node + 1]; ++a) {
    if (residual_from(tree, a) <= 0) continue;
    const std::uint32_t other = arcs_[a].head;
    if (elsewhere(other)) continue;
    if (tree_[other] == kFree) {
      tree_[other] = tree;
      parent_[other] = arcs_[a].sister;
      stamp_[other] = stamp_[node];
      distance_[other] = distance_[node] + 1;
      activate(other);
    } else if (tree_[other] != tree) {
      return tree == kSource ? a : arcs_[a].sister;
    } else if (stamp_[other] <= stamp_[node] && distance_[other] > distance_[node] + 1) {
      parent_[other] = arcs_[a].sister;  // a shorter way to the terminal
      stamp_[other] = stamp_[node];
      distance_[other] = distance_[node] + 1;
    }
  }
  return kNone;
}

template <bool kInBlock>
void MinCut::Search<kInBlock>::make_orphan(std::uint32_t node) {
  parent_[node] = kOrphan;
  orphans_.push_back(node);
}

template <bool kInBlock>
void MinCut::Search<kInBlock>::augment(std::uint32_t middle) {
  const std::uint32_t source_end = arcs_[arcs_[middle].sister].head, sink_end = arcs_[middle].head;
  std::int32_t flow = arcs_[middle].residual;
  std::uint32_t node = source_end;
  for (; parent_[node] != kTerminal; node = arcs_[parent_[node]].head)
    flow = std::min(flow, arcs_[arcs_[parent_[node]].sister].residual);
  flow = std::min(flow, terminal_[node]);
  for (node = sink_end; parent_[node] != kTerminal; node = arcs_[parent_[node]].head)
    flow = std::min(flow, arcs_[parent_[node]].residual);
  flow = std::min(flow, -terminal_[node]);

  arcs_[middle].residual -= flow;
  arcs_[arcs_[middle].sister].residual += flow;
  for (node = source_end; parent_[node] != kTerminal;) {
    const std::uint32_t up = parent_[node];
    arcs_[up].residual += flow;
    if ((arcs_[arcs_[up].sister].residual -= flow) == 0) make_orphan(node);
    node = arcs_[up].head;
  }
  if ((terminal_[node] -= flow) == 0) make_orphan(node);
  for (node = sink_end; parent_[node] != kTerminal;) {
    const std::uint32_t up = parent_[node];
    arcs_[arcs_[up].sister].residual += flow;
    if ((arcs_[up].residual -= flow) == 0) make_orphan(node);
    node = arcs_[up].head;
  }
  if ((terminal_[node] += flow) == 0) make_orphan(node);
}

/// Follows the parents; on success `distance` is that of `node` from its terminal.
template <bool kInBlock>
bool MinCut::Search<kInBlock>::reaches_terminal(std::uint32_t node, std::uint32_t& distance) const {
  distance = 0;
  for (;;) {
    if (stamp_[node] == time_) {
      distance += distance_[node];
      return true;
    }
    const std::uint32_t up = parent_[node];
    ++distance;
    if (up == kTerminal) return true;
    if (up == kOrphan || up == kNone) return false;
    node = arcs_[up].head;
  }
}

template <bool kInBlock>
void MinCut::Search<kInBlock>::mark_path(std::uint32_t node, std::uint32_t distance) {
  while (stamp_[node] != time_) {
    stamp_[node] = time_;
    distance_[node] = distance--;
    if (parent_[node] == kTerminal) break;
    node = arcs_[parent_[node]].head;
  }
}

template <bool kInBlock>
void MinCut::Search<kInBlock>::adopt(std::uint32_t orphan) {
  const Tree tree = static_cast<Tree>(tree_[orphan]);
  std::uint32_t best = kNone, best_distance = 0xffffffffu;
  for (std::uint32_t a = first_arc_[orphan]; a < first_arc_[orphan + 1]; ++a) {
    const std::uint32_t other = arcs_[a].head;
    if (elsewhere(other) || tree_[other] != tree || residual_from(tree, arcs_[a].sister) <= 0) continue;
    std::uint32_t distance = 0;
    if (!reaches_terminal(other, distance)) continue;
    if (distance < best_distance) {
      best = a;
      best_distance = distance;
    }
    mark_path(other, distance);
  }
  if (best != kNone) {
    parent_[orphan] = best;
    stamp_[orphan] = time_;
    distance_[orphan] = best_distance + 1;
    return;
  }
  for (std::uint32_t a = first_arc_[orphan]; a < first_arc_[orphan + 1]; ++a) {
    const std::uint32_t other = arcs_[a].head;
    if (elsewhere(other) || tree_[other] != tree) continue;
    if (residual_from(tree, arcs_[a].sister) > 0) activate(other);
    const std::uint32_t up = parent_[other];
    if (up != kTerminal && up != kOrphan && up != kNone && arcs_[up].head == orphan) make_orphan(other);
  }
  tree_[orphan] = kFree;
  parent_[orphan] = kNone;
}

template <bool kInBlock>
bool MinCut::Search<kInBlock>::run(Progress& progress) {
  std::uint32_t node = kNone;
  for (std::uint64_t step = 0;; ++step) {
    if ((step & 0xfff) == 0 && progress.cancelled()) return false;
    if (node == kNone || tree_[node] == kFree) {
      node = kNone;
      while (queue_head_ < queue_.size()) {
        const std::uint32_t next = queue_[queue_head_++];
        active_[next] = 0;
        if (tree_[next] != kFree) {
          node = next;
          break;
        }
      }
      if (queue_head_ > (queue_.size() >> 1) + 4096) {
        queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(queue_head_));
        queue_head_ = 0;
      }
      if (node == kNone) return true;
    }
    const std::uint32_t middle = grow(node);
    if (middle == kNone) {
      node = kNone;
      continue;
    }
    ++time_;
    augment(middle);  // the node stays current: it may have more paths
    for (std::size_t i = 0; i < orphans_.size(); ++i) adopt(orphans_[i]);
    orphans_.clear();
  }
}

Result<void> MinCut::solve(Progress& progress) {
  build();
  const auto nodes = static_cast<std::uint32_t>(terminal_.size());
  DUBSAR_CHECK(block_.empty() || block_.size() == nodes);
  std::uint32_t time = 0;
  if (blocks_ > 1) {
    std::vector<std::vector<std::uint32_t>> inside(blocks_);
    for (std::uint32_t n = 0; n < nodes; ++n)
      if (tree_[n] != kFree) inside[block_[n]].push_back(n);
    std::vector<std::uint32_t> times(blocks_, 0);
    parallel_for(blocks_, 1, [&](std::int64_t b) {
      const auto block = static_cast<std::uint32_t>(b);
      Search<true> search(*this, block, 0);
      for (const std::uint32_t n : inside[block]) search.activate(n);
      if (search.run(progress)) times[block] = search.time();
    });
    if (progress.cancelled()) return cancelled_error();
    time = *std::max_element(times.begin(), times.end());
  }
  Search<false> search(*this, 0, time);
  for (std::uint32_t n = 0; n < nodes; ++n) {
    if (tree_[n] == kFree) continue;
    bool at_border = blocks_ <= 1;
    for (std::uint32_t a = first_arc_[n]; a < first_arc_[n + 1] && !at_border; ++a)
      at_border = block_[arcs_[a].head] != block_[n];
    if (at_border) search.activate(n);
  }
  if (!search.run(progress)) return cancelled_error();
  return {};
}

}  // namespace dubsar
