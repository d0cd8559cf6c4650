#include "core/exa/patches/patch_fans.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {
constexpr std::int64_t kFanGrain = 1 << 13;
constexpr Triangle kNothing{PatchFans::kNone, PatchFans::kNone, PatchFans::kNone};
}  // namespace

PatchFans::PatchFans(std::span<const Triangle> triangles, std::uint32_t vertices)
    : triangles_(triangles), first_(std::size_t{vertices} + 1, 0), edges_(3 * triangles.size()) {
  list_edges();
  if (!sort_edges()) return;
  beyond_.resize(triangles.size());
  parallel_for(static_cast<std::int64_t>(triangles.size()), kFanGrain, [&](std::int64_t i) {
    const Triangle& t = triangles_[static_cast<std::size_t>(i)];
    for (std::size_t c = 0; c < 3; ++c) beyond_[static_cast<std::size_t>(i)][c] = triangle(t[(c + 1) % 3], t[c]);
  });
  corners_.assign(triangles.size(), kNothing);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      if (corners_[t][c] == kNone) name_fan(t, triangles[t][c]);
  manifold_ = true;
}

/// Each vertex's edges, one vertex after another.
void PatchFans::list_edges() {
  for (const Triangle& t : triangles_)
    for (const std::uint32_t v : t) ++first_[v];
  std::uint32_t total = 0;
  for (std::uint32_t& f : first_) f = total += f;
  for (auto t = static_cast<std::uint32_t>(triangles_.size()); t-- > 0;)
    for (std::size_t c = 0; c < 3; ++c) edges_[--first_[triangles_[t][c]]] = {triangles_[t][(c + 1) % 3], t};
}

/// False: two of a vertex's edges have one end, or one is its own.
bool PatchFans::sort_edges() {
  std::atomic<bool> apart{true};
  parallel_for(static_cast<std::int64_t>(first_.size()) - 1, kFanGrain, [&](std::int64_t v) {
    const auto at = static_cast<std::size_t>(v);
    const auto edges = std::span(edges_).subspan(first_[at], first_[at + 1] - first_[at]);
    std::ranges::sort(edges, {}, &Edge::to);
    const bool good = std::ranges::adjacent_find(edges, {}, &Edge::to) == edges.end() &&
                      std::ranges::none_of(edges, [&](const Edge& e) { return e.to == at; });
    if (!good) apart.store(false, std::memory_order_relaxed);
  });
  return apart;
}

std::uint32_t PatchFans::triangle(std::uint32_t from, std::uint32_t to) const {
  const std::span<const Edge> edges = edges_from(from);
  const auto found = std::ranges::lower_bound(edges, to, {}, &Edge::to);
  return found == edges.end() || found->to != to ? kNone : found->triangle;
}

void PatchFans::name_fan(std::uint32_t first, std::uint32_t vertex) {
  const auto name = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(vertex);
  for (std::uint32_t t = first; t != kNone && corners_[t][place(t, vertex)] == kNone; t = next_around(t, vertex))
    corners_[t][place(t, vertex)] = name;
  for (std::uint32_t t = first;;) {  // and the other way round
    t = beyond_[t][place(t, vertex)];
    if (t == kNone || corners_[t][place(t, vertex)] != kNone) break;
    corners_[t][place(t, vertex)] = name;
  }
}

std::vector<std::vector<std::uint32_t>> PatchFans::rims() const {
  struct RimEdge {
    std::uint32_t from, to, from_corner;
  };
  std::vector<RimEdge> edges;
  std::vector<std::uint32_t> next(vertices_.size(), kNone);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      if (beyond_[t][c] != kNone) continue;
      const std::size_t d = (c + 1) % 3;
      edges.push_back({triangles_[t][c], triangles_[t][d], corners_[t][c]});
      next[corners_[t][c]] = corners_[t][d];
    }
  std::ranges::sort(edges, {}, [](const RimEdge& e) { return std::pair(e.from, e.to); });
  std::vector<std::vector<std::uint32_t>> rims;
  for (const RimEdge& e : edges) {
    if (next[e.from_corner] == kNone) continue;  // seen
    rims.emplace_back();
    for (std::uint32_t at = e.from_corner; next[at] != kNone;) {
      rims.back().push_back(at);
      at = std::exchange(next[at], kNone);
    }
  }
  return rims;
}

std::vector<std::uint32_t> PatchFans::inside(std::uint32_t end, std::span<const std::uint32_t> on_rims) const {
  std::vector<bool> known(vertices_.size(), false);
  for (const std::uint32_t corner : on_rims) known[corner] = true;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t corner = 0; corner < vertices_.size(); ++corner)
    if (vertices_[corner] < end && !known[corner]) corners.push_back(corner);
  std::ranges::stable_sort(corners, {}, [&](std::uint32_t corner) { return vertices_[corner]; });
  return corners;
}

std::vector<std::uint32_t> PatchFans::closed_pieces(std::uint32_t end) const {
  std::vector<bool> seen(triangles_.size(), false);
  const auto see_piece = [&](std::uint32_t first) {
    std::vector<std::uint32_t> front{first};
    seen[first] = true;
    bool rim = false;
    std::uint32_t lowest = kNone;
    while (!front.empty()) {
      const std::uint32_t t = front.back();
      if (*std::ranges::min_element(triangles_[t]) >= end) lowest = std::min(lowest, t);
      front.pop_back();
      for (const std::uint32_t beyond : beyond_[t]) {
        rim = rim || beyond == kNone;
        if (beyond == kNone || seen[beyond]) continue;
        seen[beyond] = true;
        front.push_back(beyond);
      }
    }
    return std::pair(rim, lowest);
  };
  std::vector<std::uint32_t> pieces;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (seen[t]) continue;
    const auto [rim, lowest] = see_piece(t);
    if (!rim) pieces.push_back(lowest);
  }
  std::ranges::sort(pieces);
  return pieces;
}

}  // namespace dubsar
