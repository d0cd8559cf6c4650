#pragma once
// The search for ways from the source to the sink of a lattice (Boykov and Kolmogorov 2004).

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/contact/cut/lattice_graph.h"

namespace dubsar {

/// Two trees, from the source and to the sink, that grow from a queue of active points until they meet. There flow is
/// sent; points whose way is used up take another parent or leave the tree.
class LatticeSearch {
 public:
  /// Borrows the graph. Points [begin, end): what is beyond does not exist. `time`: of what was searched before.
  LatticeSearch(LatticeGraph& graph, std::uint32_t begin, std::uint32_t end, std::uint32_t time, Progress& progress)
      : graph_(graph), begin_(begin), end_(end), progress_(progress), time_(time) {}

  /// Trees of what is at the terminals, and no more.
  void plant();
  /// Points of trees from which more may be reached than when the search ended.
  void wake(std::span<const std::uint32_t> points);
  /// Until the trees do not meet any more. False: cancelled.
  bool run();
  std::uint32_t time() const noexcept { return time_; }

 private:
  using Graph = LatticeGraph;
  struct Meeting {
    std::uint32_t source_end = Graph::kNoArc, arc = Graph::kNoArc;
  };

  bool elsewhere(std::uint32_t p) const noexcept { return p - begin_ >= end_ - begin_; }
  template <class Visit>
  void each_arc(std::uint32_t p, const Visit& visit);
  void activate(std::uint32_t p);
  bool next_active(std::uint32_t& p);
  template <bool kForth>
  std::int32_t left_on(std::uint32_t p, std::uint32_t q, std::uint32_t arc) const;
  template <bool kSource>
  Meeting grow(std::uint32_t p);
  void augment(const Meeting& meeting);
  template <bool kSource>
  std::int32_t least_on_way(std::uint32_t p);
  template <bool kSource>
  void send(std::uint32_t p, std::int32_t flow);
  void make_orphan(std::uint32_t p);
  template <bool kSource>
  void adopt(std::uint32_t orphan);
  std::uint32_t up(std::uint32_t p) const { return graph_.points[p].up; }
  bool reaches_terminal(std::uint32_t p, std::int32_t& distance) const;
  template <bool kSource>
  void mark_way(std::uint32_t p, std::int32_t distance);

  LatticeGraph& graph_;
  std::uint32_t begin_, end_;
  Progress& progress_;
  std::vector<std::uint32_t> queue_, orphans_;
  std::size_t queue_head_ = 0;
  std::uint32_t time_;
};

}  // namespace dubsar
