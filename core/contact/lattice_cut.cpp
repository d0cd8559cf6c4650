#include "core/contact/lattice_cut.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::uint64_t kBetweenLooks = 4096;  ///< points that grow, for whether somebody has cancelled
constexpr std::size_t kJoined = 4;             ///< ranges that become one, until there are two at most

std::vector<std::uint32_t> joined(const std::vector<std::uint32_t>& starts) {
  const std::size_t ranges = starts.size() - 1, step = std::min(kJoined, (ranges + 1) / 2);
  std::vector<std::uint32_t> fewer;
  for (std::size_t i = 0; i < ranges; i += step) fewer.push_back(starts[i]);
  fewer.push_back(starts.back());
  return fewer;
}
constexpr std::uint32_t sister(std::uint32_t arc) { return arc ^ 1; }
}  // namespace

LatticeCut::LatticeCut(std::vector<std::uint32_t> block, std::uint32_t blocks, const std::vector<float>& height)
    : place_(std::move(block)),
      first_(blocks + 1, 0),
      points_(place_.size()),
      height_(place_.size()),
      rising_(place_.size()) {
  for (const std::uint32_t b : place_) ++first_[b + 1];  // still blocks
  for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t n = 0; n < place_.size(); ++n) {
    place_[n] = next[place_[n]]++;
    height_[place_[n]] = height[n];
  }
  parallel_for(blocks, 1, [&](std::int64_t b) {
    const std::uint32_t begin = first_[static_cast<std::size_t>(b)], end = first_[static_cast<std::size_t>(b) + 1];
    std::fill(points_.begin() + begin, points_.begin() + end, kAlone);
    list_rising(begin, end);
  });
}

/// In layers so thin that neighbours seldom share one.
void LatticeCut::list_rising(std::uint32_t begin, std::uint32_t end) {
  if (begin == end) return;
  constexpr std::size_t kLayers = 1 << 10;
  const auto [low, high] = std::minmax_element(height_.begin() + begin, height_.begin() + end);
  const float least = *low, scale = static_cast<float>(kLayers - 1) / std::max(*high - least, 1e-6f);
  const auto layer = [&](std::uint32_t p) { return static_cast<std::size_t>(scale * (height_[p] - least)); };
  std::array<std::uint32_t, kLayers + 1> next{begin};
  for (std::uint32_t p = begin; p < end; ++p) ++next[layer(p) + 1];
  for (std::size_t k = 1; k <= kLayers; ++k) next[k] += next[k - 1];
  for (std::uint32_t p = begin; p < end; ++p) rising_[next[layer(p)]++] = p;
}

void LatticeCut::add_step_cost(std::uint32_t lower, std::uint32_t upper, std::uint32_t axis, std::int32_t cost) {
  Point &a = points_[place_[lower]], &b = points_[place_[upper]];
  const std::size_t up = 2 * std::size_t{axis}, down = up + 1;
  a.beside[up] = place_[upper];
  b.beside[down] = place_[lower];
  a.residual[up] += cost;
  b.residual[down] += cost;
}

void LatticeCut::add_tie(std::uint32_t from, std::uint32_t to, std::int32_t cost) {
  const auto [first, fresh] = first_tie_.try_emplace(from, kNone);
  ties_.push_back({to, first->second, cost});
  first->second = static_cast<std::uint32_t>(ties_.size() - 1);
  points_[from].tied = 1;
}

void LatticeCut::tie(std::uint32_t a, std::uint32_t b, std::int32_t cost) {
  add_tie(place_[a], place_[b], cost);
  add_tie(place_[b], place_[a], cost);
}

/// What the source has left at a point goes up as far as it can, what the sink lacks goes down.
template <bool kSource>
void LatticeCut::wave(std::uint32_t begin, std::uint32_t end) {
  const auto left = [](const Point& point) { return kSource ? point.terminal : -point.terminal; };
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t p = rising_[kSource ? i : end - 1 - (i - begin)];
    Point& point = points_[p];
    for (std::uint32_t way = 0; way < kWays && left(point) > 0; ++way) {
      const std::uint32_t q = point.beside[way];
      if (q - begin >= end - begin || (kSource ? height_[q] <= height_[p] : height_[q] >= height_[p])) continue;
      Point& other = points_[q];
      std::int32_t& forth = kSource ? point.residual[way] : other.residual[sister(way)];
      std::int32_t& back = kSource ? other.residual[sister(way)] : point.residual[way];
      const std::int32_t flow = std::min(forth, left(point));
      forth -= flow;
      back += flow;
      point.terminal -= kSource ? flow : -flow;
      other.terminal += kSource ? flow : -flow;
    }
  }
}

/// Two trees, from the source and to the sink, that grow from a queue of active points until they meet. There flow is
/// sent; points whose way is used up take another parent or leave the tree.
class LatticeCut::Search {
 public:
  Search(LatticeCut& cut, std::uint32_t begin, std::uint32_t end, std::uint32_t time, Progress& progress)
      : points_(cut.points_),
        ties_(cut.ties_),
        first_tie_(cut.first_tie_),
        begin_(begin),
        end_(end),
        progress_(progress),
        time_(time) {}

  /// Trees of what is at the terminals, and no more.
  void plant();
  /// Points of trees from which more may be reached than when the search ended.
  void wake(std::span<const std::uint32_t> points) {
    for (const std::uint32_t p : points)
      if (points_[p].label != 0) activate(points_[p]);
  }
  bool run();
  std::uint32_t time() const { return time_; }

 private:
  struct Meeting {
    std::uint32_t source_end = kNone, arc = kNone;
  };

  bool elsewhere(std::uint32_t p) const { return p - begin_ >= end_ - begin_; }  // and kNone
  std::uint32_t id(const Point& point) const { return static_cast<std::uint32_t>(&point - points_.data()); }
  template <bool kSource>
  static std::int32_t level(const Point& point) {
    return kSource ? point.label : -point.label;
  }
  Point& head(const Point& point, std::uint32_t arc) {
    return points_[arc < kWays ? point.beside[arc] : ties_[arc - kWays].head];
  }
  std::int32_t& residual(Point& point, std::uint32_t arc) {
    return arc < kWays ? point.residual[arc] : ties_[arc - kWays].residual;
  }
  template <bool kForth>
  std::int32_t& residual_of(Point& point, Point& other, std::uint32_t arc) {
    return kForth ? residual(point, arc) : residual(other, sister(arc));
  }
  /// visit(arc, other) until it says false.
  template <class Visit>
  void each_arc(const Point& point, const Visit& visit) {
    for (std::uint32_t way = 0; way < kWays; ++way) {
      const std::uint32_t other = point.beside[way];
      if (!elsewhere(other) && !visit(way, points_[other])) return;
    }
    if (!point.tied) return;
    for (std::uint32_t t = first_tie_.at(id(point)); t != kNone; t = ties_[t].next)
      if (!elsewhere(ties_[t].head) && !visit(kWays + t, points_[ties_[t].head])) return;
  }

  void activate(Point& point) {
    if (point.active) return;
    point.active = 1;
    queue_.push_back(id(point));
  }
  Point* next_active();
  template <bool kSource>
  void set(Point& point, std::uint32_t parent, std::int32_t level, std::uint32_t time) {
    point.parent = parent;
    point.label = kSource ? level : -level;
    point.time = time & kMostTime;
  }
  template <bool kSource>
  Meeting grow(Point& point);
  void augment(const Meeting& meeting);
  template <bool kSource>
  std::int32_t least_on_way(Point& point);
  template <bool kSource>
  void send(Point& point, std::int32_t flow);
  void make_orphan(Point& point) {
    point.parent = kOrphan;
    orphans_.push_back(id(point));
  }
  template <bool kSource>
  void adopt(Point& orphan);
  bool reaches_terminal(Point& point, std::int32_t& distance);
  template <bool kSource>
  void mark_way(Point& point, std::int32_t distance);

  static constexpr std::uint32_t kMostTime = (1u << 30) - 1;
  LargeArray<Point>& points_;
  std::vector<Tie>& ties_;
  const std::unordered_map<std::uint32_t, std::uint32_t>& first_tie_;
  std::uint32_t begin_, end_;
  Progress& progress_;
  std::vector<std::uint32_t> queue_, orphans_;
  std::size_t queue_head_ = 0;
  std::uint32_t time_;
};

LatticeCut::Point* LatticeCut::Search::next_active() {
  while (queue_head_ < queue_.size()) {
    Point& next = points_[queue_[queue_head_++]];
    next.active = 0;
    if (queue_head_ > (queue_.size() >> 1) + 4096) {
      queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(queue_head_));
      queue_head_ = 0;
    }
    if (next.label != 0) return &next;
  }
  return nullptr;
}

void LatticeCut::Search::plant() {
  for (std::uint32_t p = begin_; p < end_; ++p) {
    Point& point = points_[p];
    point.label = point.terminal > 0 ? 1 : point.terminal < 0 ? -1 : 0;
    point.parent = point.label != 0 ? kTerminal : kNone;
    point.time = 0;
    point.active = 0;
    if (point.label != 0) activate(point);
  }
}

bool LatticeCut::Search::run() {
  Point* point = nullptr;
  for (std::uint64_t step = 0;; ++step) {
    if (step % kBetweenLooks == 0 && progress_.cancelled()) return false;
    if (point == nullptr || point->label == 0) point = next_active();
    if (point == nullptr) return true;
    const Meeting meeting = point->label > 0 ? grow<true>(*point) : grow<false>(*point);
    if (meeting.arc == kNone) {
      point = nullptr;
      continue;
    }
    DUBSAR_CHECK(time_ < kMostTime);
    ++time_;
    augment(meeting);  // the point stays current: it may have more ways
    for (std::size_t i = 0; i < orphans_.size(); ++i) {
      Point& orphan = points_[orphans_[i]];
      orphan.label > 0 ? adopt<true>(orphan) : adopt<false>(orphan);
    }
    orphans_.clear();
  }
}

/// Looks for an arc to the other tree around an active point, and adds free neighbours to its own.
template <bool kSource>
LatticeCut::Search::Meeting LatticeCut::Search::grow(Point& point) {
  Meeting meeting;
  const std::int32_t next = level<kSource>(point) + 1;
  each_arc(point, [&](std::uint32_t arc, Point& other) {
    if (residual_of<kSource>(point, other, arc) <= 0) return true;
    const std::int32_t there = level<kSource>(other);
    if (there < 0) {
      meeting = kSource ? Meeting{id(point), arc} : Meeting{id(other), sister(arc)};
      return false;
    }
    if (there == 0) {
      set<kSource>(other, sister(arc), next, point.time);
      activate(other);
    } else if (other.time <= point.time && there > next) {
      set<kSource>(other, sister(arc), next, point.time);  // a shorter way to the terminal
    }
    return true;
  });
  return meeting;
}

template <bool kSource>
std::int32_t LatticeCut::Search::least_on_way(Point& point) {
  std::int32_t least = 0x7fffffff;
  Point* at = &point;
  while (at->parent != kTerminal) {
    Point& up = head(*at, at->parent);
    least = std::min(least, residual_of<!kSource>(*at, up, at->parent));
    at = &up;
  }
  return std::min(least, kSource ? at->terminal : -at->terminal);
}

template <bool kSource>
void LatticeCut::Search::send(Point& point, std::int32_t flow) {
  Point* at = &point;
  while (at->parent != kTerminal) {
    const std::uint32_t arc = at->parent;
    Point& up = head(*at, arc);
    residual_of<kSource>(*at, up, arc) += flow;
    if ((residual_of<!kSource>(*at, up, arc) -= flow) == 0) make_orphan(*at);
    at = &up;
  }
  at->terminal -= kSource ? flow : -flow;
  if (at->terminal == 0) make_orphan(*at);
}

void LatticeCut::Search::augment(const Meeting& meeting) {
  Point &source_end = points_[meeting.source_end], &sink_end = head(source_end, meeting.arc);
  std::int32_t& forth = residual(source_end, meeting.arc);
  const std::int32_t flow = std::min({forth, least_on_way<true>(source_end), least_on_way<false>(sink_end)});
  forth -= flow;
  residual(sink_end, sister(meeting.arc)) += flow;
  send<true>(source_end, flow);
  send<false>(sink_end, flow);
}

/// Follows the parents; on success `distance` is that of the point from its terminal.
bool LatticeCut::Search::reaches_terminal(Point& point, std::int32_t& distance) {
  distance = 0;
  for (Point* at = &point;; at = &head(*at, at->parent)) {
    if (at->time == time_) {
      distance += std::abs(at->label);
      return true;
    }
    ++distance;
    if (at->parent == kTerminal) return true;
    if (at->parent == kOrphan || at->parent == kNone) return false;
  }
}

template <bool kSource>
void LatticeCut::Search::mark_way(Point& point, std::int32_t distance) {
  for (Point* at = &point; at->time != time_; at = &head(*at, at->parent)) {
    set<kSource>(*at, at->parent, distance--, time_);
    if (at->parent == kTerminal) break;
  }
}

template <bool kSource>
void LatticeCut::Search::adopt(Point& orphan) {
  std::uint32_t parent = kNone;
  std::int32_t least = 0x7fffffff;
  each_arc(orphan, [&](std::uint32_t arc, Point& other) {
    if (level<kSource>(other) <= 0 || residual_of<!kSource>(orphan, other, arc) <= 0) return true;
    std::int32_t distance = 0;
    if (!reaches_terminal(other, distance)) return true;
    if (distance < least) {
      parent = arc;
      least = distance;
    }
    mark_way<kSource>(other, distance);
    return true;
  });
  if (parent != kNone) {
    set<kSource>(orphan, parent, least + 1, time_);
    return;
  }
  each_arc(orphan, [&](std::uint32_t arc, Point& other) {
    if (level<kSource>(other) <= 0) return true;
    if (residual_of<!kSource>(orphan, other, arc) > 0) activate(other);
    if (other.parent == sister(arc)) make_orphan(other);
    return true;
  });
  orphan.label = 0;
  orphan.parent = kNone;
}

void LatticeCut::solve_ranges(const std::vector<std::uint32_t>& starts, bool first, Progress& progress) {
  const std::size_t ranges = starts.size() - 1;
  std::vector<std::vector<std::uint32_t>> ends(ranges);
  std::vector<std::uint32_t> times(ranges, time_);
  const std::uint32_t time = time_;
  parallel_for(static_cast<std::int64_t>(ranges), 1, [&](std::int64_t i) {
    const auto r = static_cast<std::size_t>(i);
    const std::uint32_t begin = starts[r], end = starts[r + 1];
    Search search(*this, begin, end, time, progress);
    if (first) {
      wave<true>(begin, end);
      wave<false>(begin, end);
      search.plant();
    } else {
      search.wake(std::span(std::lower_bound(touched_.begin(), touched_.end(), begin),
                            std::lower_bound(touched_.begin(), touched_.end(), end)));
    }
    if (!search.run()) return;
    times[r] = search.time();
    for (std::uint32_t p = begin; p < end; ++p) {
      const auto out = [&](std::uint32_t q) { return q != kNone && q - begin >= end - begin; };
      if (points_[p].tied || std::any_of(points_[p].beside.begin(), points_[p].beside.end(), out)) ends[r].push_back(p);
    }
  });
  if (first) height_ = {}, rising_ = {};
  touched_.clear();
  for (const std::vector<std::uint32_t>& some : ends) touched_.insert(touched_.end(), some.begin(), some.end());
  time_ = *std::max_element(times.begin(), times.end());
}

/// The trees of the blocks go on growing together: only what touches another block has something left to find.
Result<void> LatticeCut::solve(Progress& progress) {
  if (points_.empty()) return {};
  solve_ranges(first_, true, progress);
  for (std::vector<std::uint32_t> starts = first_; starts.size() > 3 && !progress.cancelled();) {
    starts = joined(starts);
    solve_ranges(starts, false, progress);
  }
  if (progress.cancelled()) return cancelled_error();
  Search search(*this, 0, static_cast<std::uint32_t>(points_.size()), time_, progress);
  search.wake(touched_);
  if (!search.run()) return cancelled_error();
  return {};
}

}  // namespace dubsar
