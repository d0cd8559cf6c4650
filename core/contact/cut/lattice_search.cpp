#include "core/contact/cut/lattice_search.h"

#include <algorithm>
#include <cstdlib>

namespace dubsar {
namespace {

constexpr std::uint64_t kBetweenLooks = 4096;  ///< points that grow, for whether somebody has cancelled
constexpr std::int32_t kMostLabel = 0x7fff;    ///< farther is taken for as far: labels choose ways, no more

template <bool kSource>
std::int32_t level(const LatticeGraph::Point& point) {
  return kSource ? point.label : -point.label;
}

template <bool kSource>
void set(LatticeGraph::Point& point, std::int32_t level, std::uint32_t time) {
  const std::int32_t most = std::min(level, kMostLabel);
  point.label = static_cast<std::int16_t>(kSource ? most : -most);
  point.time = time;
}

}  // namespace

/// visit(arc, other) until it says false.
template <class Visit>
void LatticeSearch::each_arc(std::uint32_t p, const Visit& visit) {
  for (std::uint32_t way = 0; way < Graph::kWays; ++way) {
    const std::uint32_t other = graph_.bricks.beside(p, way);
    if (!elsewhere(other) && !visit(way, other)) return;
  }
  if ((graph_.points[p].flags & Graph::kTied) == 0) return;
  for (std::uint32_t t = graph_.tied.at(p).first; t != Graph::kNoArc; t = graph_.ties[t].next)
    if (const std::uint32_t other = graph_.ties[t].head; !elsewhere(other) && !visit(Graph::kTies + t, other)) return;
}

/// What can still be sent on an arc from p to q, or the other way.
template <bool kForth>
std::int32_t LatticeSearch::left_on(std::uint32_t p, std::uint32_t q, std::uint32_t arc) const {
  return kForth ? graph_.residual(p, arc) : graph_.residual(q, Graph::sister(arc));
}

void LatticeSearch::activate(std::uint32_t p) {
  std::uint8_t& flags = graph_.points[p].flags;
  if ((flags & Graph::kActive) != 0) return;
  flags |= Graph::kActive;
  queue_.push_back(p);
}

void LatticeSearch::wake(std::span<const std::uint32_t> points) {
  for (const std::uint32_t p : points)
    if (graph_.points[p].label != 0) activate(p);
}

void LatticeSearch::make_orphan(std::uint32_t p) {
  graph_.points[p].parent = Graph::kOrphan;
  orphans_.push_back(p);
}

bool LatticeSearch::next_active(std::uint32_t& p) {
  while (queue_head_ < queue_.size()) {
    p = queue_[queue_head_++];
    graph_.points[p].flags &= static_cast<std::uint8_t>(~Graph::kActive);
    if (queue_head_ > (queue_.size() >> 1) + 4096) {
      queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(queue_head_));
      queue_head_ = 0;
    }
    if (graph_.points[p].label != 0) return true;
  }
  return false;
}

void LatticeSearch::plant() {
  for (std::uint32_t p = begin_; p < end_; ++p) {
    Graph::Point& point = graph_.points[p];
    point.label = point.terminal > 0 ? 1 : point.terminal < 0 ? -1 : 0;
    point.parent = point.label != 0 ? Graph::kTerminal : Graph::kNoParent;
    if (point.label != 0) activate(p);
  }
}

bool LatticeSearch::run() {
  std::uint32_t p = Graph::kNoArc;
  for (std::uint64_t step = 0;; ++step) {
    if (step % kBetweenLooks == 0 && progress_.cancelled()) return false;
    if ((p == Graph::kNoArc || graph_.points[p].label == 0) && !next_active(p)) return true;
    const Meeting meeting = graph_.points[p].label > 0 ? grow<true>(p) : grow<false>(p);
    if (meeting.arc == Graph::kNoArc) {
      p = Graph::kNoArc;
      continue;
    }
    ++time_;
    DUBSAR_CHECK(time_ != 0);
    augment(meeting);  // the point stays current: it may have more ways
    for (std::size_t i = 0; i < orphans_.size(); ++i) {
      const std::uint32_t orphan = orphans_[i];
      graph_.points[orphan].label > 0 ? adopt<true>(orphan) : adopt<false>(orphan);
    }
    orphans_.clear();
  }
}

/// Looks for an arc to the other tree around an active point, and adds free neighbours to its own.
template <bool kSource>
LatticeSearch::Meeting LatticeSearch::grow(std::uint32_t p) {
  Meeting meeting;
  const Graph::Point& point = graph_.points[p];
  const std::int32_t next = level<kSource>(point) + 1;
  each_arc(p, [&](std::uint32_t arc, std::uint32_t q) {
    Graph::Point& other = graph_.points[q];
    if (left_on<kSource>(p, q, arc) <= 0) return true;
    const std::int32_t there = level<kSource>(other);
    if (there < 0) {
      meeting = kSource ? Meeting{p, arc} : Meeting{q, Graph::sister(arc)};
      return false;
    }
    if (there == 0) {
      set<kSource>(other, next, point.time);
      graph_.set_parent(q, Graph::sister(arc), p);
      activate(q);
    } else if (other.time <= point.time && there > next) {
      set<kSource>(other, next, point.time);  // a shorter way to the terminal
      graph_.set_parent(q, Graph::sister(arc), p);
    }
    return true;
  });
  return meeting;
}

template <bool kSource>
std::int32_t LatticeSearch::least_on_way(std::uint32_t p) {
  std::int32_t least = 0x7fffffff;
  while (graph_.points[p].parent != Graph::kTerminal) {
    const std::uint32_t arc = graph_.parent(p), q = graph_.points[p].up;
    least = std::min(least, left_on<!kSource>(p, q, arc));
    p = q;
  }
  return std::min(least, kSource ? graph_.points[p].terminal : -graph_.points[p].terminal);
}

template <bool kSource>
void LatticeSearch::send(std::uint32_t p, std::int32_t flow) {
  while (graph_.points[p].parent != Graph::kTerminal) {
    const std::uint32_t arc = graph_.parent(p), q = graph_.points[p].up;
    const std::uint32_t back = Graph::sister(arc);
    kSource ? graph_.add(p, arc, flow) : graph_.add(q, back, flow);
    if ((kSource ? graph_.add(q, back, -flow) : graph_.add(p, arc, -flow)) == 0) make_orphan(p);
    p = q;
  }
  if ((graph_.points[p].terminal -= kSource ? flow : -flow) == 0) make_orphan(p);
}

void LatticeSearch::augment(const Meeting& meeting) {
  const std::uint32_t source_end = meeting.source_end, sink_end = graph_.head(source_end, meeting.arc);
  const std::int32_t flow = std::min(
      {graph_.residual(source_end, meeting.arc), least_on_way<true>(source_end), least_on_way<false>(sink_end)});
  graph_.add(source_end, meeting.arc, -flow);
  graph_.add(sink_end, Graph::sister(meeting.arc), flow);
  send<true>(source_end, flow);
  send<false>(sink_end, flow);
}

/// Follows the parents; on success `distance` is that of the point from its terminal.
bool LatticeSearch::reaches_terminal(std::uint32_t p, std::int32_t& distance) const {
  for (distance = 0;; p = up(p)) {
    const Graph::Point& point = graph_.points[p];
    if (point.time == time_) {
      distance += std::abs(point.label);
      return true;
    }
    ++distance;
    if (point.parent == Graph::kTerminal) return true;
    if (point.parent == Graph::kOrphan || point.parent == Graph::kNoParent) return false;
  }
}

template <bool kSource>
void LatticeSearch::mark_way(std::uint32_t p, std::int32_t distance) {
  for (; graph_.points[p].time != time_; p = up(p)) {
    set<kSource>(graph_.points[p], distance--, time_);
    if (graph_.points[p].parent == Graph::kTerminal) break;
  }
}

template <bool kSource>
void LatticeSearch::adopt(std::uint32_t orphan) {
  std::uint32_t best = Graph::kNoArc, best_up = 0;
  std::int32_t least = 0x7fffffff;
  each_arc(orphan, [&](std::uint32_t arc, std::uint32_t q) {
    const Graph::Point& other = graph_.points[q];
    if (level<kSource>(other) <= 0 || left_on<!kSource>(orphan, q, arc) <= 0) return true;
    std::int32_t distance = 0;
    if (!reaches_terminal(q, distance)) return true;
    if (distance < least) {
      best = arc;
      best_up = q;
      least = distance;
    }
    mark_way<kSource>(q, distance);
    return true;
  });
  if (best != Graph::kNoArc) {
    set<kSource>(graph_.points[orphan], least + 1, time_);
    graph_.set_parent(orphan, best, best_up);
    return;
  }
  each_arc(orphan, [&](std::uint32_t arc, std::uint32_t q) {
    if (level<kSource>(graph_.points[q]) <= 0) return true;
    if (left_on<!kSource>(orphan, q, arc) > 0) activate(q);
    if (graph_.parent(q) == Graph::sister(arc)) make_orphan(q);
    return true;
  });
  graph_.points[orphan].label = 0;
  graph_.points[orphan].parent = Graph::kNoParent;
}

}  // namespace dubsar
