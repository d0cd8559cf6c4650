#include "core/contact/cut/lattice_cut.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>

#include "core/base/system/parallel.h"
#include "core/contact/cut/lattice_search.h"

namespace dubsar {
namespace {

constexpr std::size_t kJoined = 4;  ///< ranges that become one, until there are two at most

std::vector<std::uint32_t> joined(const std::vector<std::uint32_t>& starts) {
  const std::size_t ranges = starts.size() - 1, step = std::min(kJoined, (ranges + 1) / 2);
  std::vector<std::uint32_t> fewer;
  for (std::size_t i = 0; i < ranges; i += step) fewer.push_back(starts[i]);
  fewer.push_back(starts.back());
  return fewer;
}

/// What the source has left at a point of a range goes up as far as it can, what the sink lacks goes down.
class Wave {
 public:
  using Graph = LatticeGraph;
  Wave(LatticeGraph& graph, std::uint32_t begin, std::uint32_t end)
      : bricks_(graph.bricks), points_(graph.points), begin_(begin), end_(end) {
    list_rising();
  }
  template <bool kSource>
  void run() {
    for (std::size_t i = 0; i < rising_.size(); ++i) send<kSource>(rising_[kSource ? i : rising_.size() - 1 - i]);
  }

 private:
  void list_rising();
  template <bool kSource>
  void send(std::uint32_t p) {
    const auto left = [](const Graph::Point& point) { return kSource ? point.terminal : -point.terminal; };
    Graph::Point& point = points_[p];
    for (std::uint32_t way = 0; way < Graph::kWays && left(point) > 0; ++way) {
      const std::uint32_t q = bricks_.beside(p, way);
      Graph::Point& other = points_[q];
      std::uint16_t& forth = kSource ? point.residual[way] : other.residual[Graph::sister(way)];
      if (forth == 0 || q - begin_ >= end_ - begin_) continue;
      if (kSource ? other.label <= point.label : other.label >= point.label) continue;
      std::uint16_t& back = kSource ? other.residual[Graph::sister(way)] : point.residual[way];
      const std::int32_t flow = std::min<std::int32_t>(forth, left(point));
      forth = static_cast<std::uint16_t>(forth - flow);
      back = static_cast<std::uint16_t>(back + flow);
      point.terminal -= kSource ? flow : -flow;
      other.terminal += kSource ? flow : -flow;
    }
  }

  const LatticeBricks& bricks_;
  LargeArray<Graph::Point>& points_;
  std::uint32_t begin_, end_;
  std::vector<std::uint32_t> rising_;  ///< layer by layer of their heights
};

/// In layers so thin that neighbours seldom share one.
void Wave::list_rising() {
  constexpr std::size_t kLabelBins = 1 << 10;
  if (begin_ == end_) return;
  const auto [low, high] =
      std::minmax_element(points_.begin() + begin_, points_.begin() + end_,
                          [](const Graph::Point& a, const Graph::Point& b) { return a.label < b.label; });
  const std::int32_t least = low->label, span = high->label - least + 1;
  const auto layer = [&](std::uint32_t p) {
    return static_cast<std::size_t>(points_[p].label - least) * kLabelBins / static_cast<std::size_t>(span);
  };
  std::array<std::uint32_t, kLabelBins + 1> next{};
  for (std::uint32_t p = begin_; p < end_; ++p) ++next[layer(p) + 1];
  for (std::size_t k = 1; k <= kLabelBins; ++k) next[k] += next[k - 1];
  rising_.resize(end_ - begin_);
  for (std::uint32_t p = begin_; p < end_; ++p) rising_[next[layer(p)]++] = p;
}

}  // namespace

LatticeCut::LatticeCut(const LatticeBricks& bricks, std::vector<std::uint32_t> starts)
    : starts_(std::move(starts)),
      graph_{bricks, LargeArray<Graph::Point>(std::size_t{Graph::kPoints} * bricks.count()), {}, {}} {
  DUBSAR_CHECK(starts_.size() > 1 && starts_.front() == 1 && starts_.back() == bricks.count());
  constexpr std::int64_t kGrain = 1 << 16;
  parallel_chunks(static_cast<std::int64_t>(graph_.points.size()), kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::fill(graph_.points.begin() + begin, graph_.points.begin() + end, Graph::Point{});
  });
}

void LatticeCut::add_step_cost(std::uint32_t point, std::uint32_t axis, std::int32_t cost) {
  const std::uint32_t up = 2 * axis;
  std::uint16_t &forth = graph_.points[point].residual[up],
                &back = graph_.points[graph_.bricks.beside(point, up)].residual[Graph::sister(up)];
  DUBSAR_CHECK(cost >= 0 && forth + cost <= kMostStep);
  forth = static_cast<std::uint16_t>(forth + cost);
  back = static_cast<std::uint16_t>(back + cost);
}

void LatticeCut::add_tie(std::uint32_t from, std::uint32_t to, std::int32_t cost) {
  Graph::Ties& ties = graph_.tied.try_emplace(from, Graph::Ties{Graph::kNoArc, Graph::kNoArc}).first->second;
  graph_.ties.push_back({to, ties.first, cost});
  ties.first = static_cast<std::uint32_t>(graph_.ties.size() - 1);
  graph_.points[from].flags |= Graph::kTied;
}

void LatticeCut::tie(std::uint32_t a, std::uint32_t b, std::int32_t cost) {
  add_tie(a, b, cost);
  add_tie(b, a, cost);
}

void LatticeCut::set_height(std::uint32_t point, float height) {
  constexpr float kOfStep = 512.0f, kMost = 32767.0f;
  graph_.points[point].label = static_cast<std::int16_t>(std::clamp(kOfStep * height, -kMost, kMost));
}

std::vector<std::uint32_t> LatticeCut::points_with_arcs_out(std::uint32_t begin, std::uint32_t end) const {
  std::vector<std::uint32_t> out;
  for (std::uint32_t b = begin; b < end; ++b) {
    std::uint64_t sides = 0;
    for (std::uint32_t way = 0; way < Graph::kWays; ++way)
      if (const std::uint32_t beside = graph_.bricks.brick_beside(b, way); beside != 0 && beside - begin >= end - begin)
        sides |= LatticeBricks::side(way);
    for (; sides != 0; sides &= sides - 1)
      out.push_back(Graph::kPoints * b + static_cast<std::uint32_t>(std::countr_zero(sides)));
  }
  return out;
}

void LatticeCut::solve_ranges(const std::vector<std::uint32_t>& starts, bool first, Progress& progress) {
  const std::size_t ranges = starts.size() - 1;
  std::vector<std::vector<std::uint32_t>> ends(ranges);
  std::vector<std::uint32_t> times(ranges, time_);
  parallel_for(static_cast<std::int64_t>(ranges), 1, [&](std::int64_t i) {
    const auto r = static_cast<std::size_t>(i);
    const std::uint32_t begin = Graph::kPoints * starts[r], end = Graph::kPoints * starts[r + 1];
    LatticeSearch search(graph_, begin, end, time_, progress);
    if (first) {
      Wave wave(graph_, begin, end);
      wave.run<true>();
      wave.run<false>();
      search.plant();
    } else {
      search.wake(std::span(std::lower_bound(touched_.begin(), touched_.end(), begin),
                            std::lower_bound(touched_.begin(), touched_.end(), end)));
    }
    if (!search.run()) return;
    times[r] = search.time();
    ends[r] = points_with_arcs_out(starts[r], starts[r + 1]);
  });
  touched_.clear();
  for (const std::vector<std::uint32_t>& some : ends) touched_.insert(touched_.end(), some.begin(), some.end());
  const auto at_sides = static_cast<std::ptrdiff_t>(touched_.size());
  for (const auto& entry : graph_.tied) touched_.push_back(entry.first);
  std::sort(touched_.begin() + at_sides, touched_.end());
  std::inplace_merge(touched_.begin(), touched_.begin() + at_sides, touched_.end());
  time_ = *std::max_element(times.begin(), times.end());
}

/// The trees of the blocks go on growing together: only what touches another block has something left to find.
Result<void> LatticeCut::solve(Progress& progress) {
  solve_ranges(starts_, true, progress);
  for (std::vector<std::uint32_t> starts = starts_; starts.size() > 3 && !progress.cancelled();) {
    starts = joined(starts);
    solve_ranges(starts, false, progress);
  }
  if (progress.cancelled()) return cancelled_error();
  LatticeSearch search(graph_, Graph::kPoints, static_cast<std::uint32_t>(graph_.points.size()), time_, progress);
  search.wake(touched_);
  if (!search.run()) return cancelled_error();
  return {};
}

}  // namespace dubsar
