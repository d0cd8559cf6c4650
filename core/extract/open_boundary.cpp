#include "core/extract/open_boundary.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/result.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

/// The fan of each kept x-quad around a vertex. Two x-quads are in one fan when they share an edge at the vertex.
struct Fans {
  std::vector<std::uint32_t> quads;  ///< kept, rising
  std::vector<std::uint32_t> fan;    ///< 0, 1, .. in order of the lowest x-quad
  std::uint32_t count = 0;
};

void find_fans(const QuadMesh& mesh, std::span<const std::uint32_t> new_quad, std::uint32_t vertex, Fans& fans) {
  fans.quads.clear();
  std::vector<std::array<std::uint32_t, 2>> sides;  // the polygon's neighbours of the vertex
  for (const std::uint32_t q : mesh.quads_of(vertex)) {
    if (new_quad[q] == kDropped) continue;
    const Polygon polygon = mesh.polygon(q);
    const int at = static_cast<int>(std::find(polygon.vertex.begin(), polygon.vertex.begin() + polygon.size, vertex) -
                                    polygon.vertex.begin());
    const auto side = [&](int i) { return polygon.vertex[static_cast<std::size_t>(i % polygon.size)]; };
    fans.quads.push_back(q);
    sides.push_back({side(at + polygon.size - 1), side(at + 1)});
  }
  const std::size_t n = fans.quads.size();
  fans.fan.resize(n);
  std::iota(fans.fan.begin(), fans.fan.end(), 0u);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (sides[i][0] != sides[j][1] && sides[i][1] != sides[j][0]) continue;
      const auto [keep, replace] = std::minmax({fans.fan[i], fans.fan[j]});
      for (std::uint32_t& f : fans.fan) f = f == replace ? keep : f;
    }
  }
  fans.count = 0;
  for (std::size_t i = 0; i < n; ++i) {  // renumber densely, in order of the lowest x-quad
    fans.fan[i] = fans.fan[i] == i ? fans.count++ : fans.fan[fans.fan[i]];
  }
}

}  // namespace

QuadMesh open_at_boundary(const QuadMesh& mesh, std::span<const std::uint8_t> in_layer) {
  DUBSAR_CHECK(in_layer.size() == mesh.positions.size());
  std::vector<std::uint32_t> new_quad(mesh.quads.size());
  std::uint32_t quads = 0;
  auto next = mesh.doubled.begin();
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
    bool keep = std::ranges::none_of(mesh.quads[q], [&](std::uint32_t v) { return in_layer[v] != 0; });
    for (; next != mesh.doubled.end() && next->quad == q; ++next) keep = keep && in_layer[next->vertex] == 0;
    new_quad[q] = keep ? quads++ : kDropped;
  }

  // Only vertices that lose an x-quad can fall apart.
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  const auto loses = [&](std::uint32_t v) {
    return std::ranges::any_of(mesh.quads_of(v), [&](std::uint32_t q) { return new_quad[q] == kDropped; });
  };
  std::vector<std::uint32_t> first(static_cast<std::size_t>(vertices) + 1, 0);  // new number of the first fan
  Fans fans;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    std::uint32_t count = 1;
    if (loses(v)) {
      find_fans(mesh, new_quad, v, fans);
      count = fans.count;
    }
    DUBSAR_CHECK(first[v] < kDropped - 13);
    first[v + 1] = first[v] + count;
  }

  QuadMesh opened;
  opened.positions.resize(first.back());
  opened.quads.resize(quads);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    for (std::uint32_t n = first[v]; n < first[v + 1]; ++n) opened.positions[n] = mesh.positions[v];
  }
  parallel_for(static_cast<std::int64_t>(mesh.quads.size()), 1 << 14, [&](std::int64_t i) {
    const auto q = static_cast<std::size_t>(i);
    if (new_quad[q] == kDropped) return;
    for (std::size_t c = 0; c < 4; ++c) opened.quads[new_quad[q]][c] = first[mesh.quads[q][c]];
  });
  for (const DoubledCorner& d : mesh.doubled) {
    if (new_quad[d.quad] != kDropped) opened.doubled.push_back({new_quad[d.quad], first[d.vertex], d.corner});
  }
  // X-quads of the second and further fans.
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (first[v + 1] - first[v] < 2) continue;
    find_fans(mesh, new_quad, v, fans);
    for (std::size_t i = 0; i < fans.quads.size(); ++i) {
      const std::uint32_t q = new_quad[fans.quads[i]];
      for (std::uint32_t& corner : opened.quads[q]) {
        if (corner == first[v]) corner = first[v] + fans.fan[i];
      }
      const auto range = std::equal_range(opened.doubled.begin(), opened.doubled.end(), DoubledCorner{q, 0, 0},
                                          [](const auto& a, const auto& b) { return a.quad < b.quad; });
      for (auto d = range.first; d != range.second; ++d) {
        if (d->vertex == first[v]) d->vertex = first[v] + fans.fan[i];
      }
    }
  }
  opened.build_incidence();
  return opened;
}

}  // namespace dubsar
