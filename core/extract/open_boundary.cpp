#include "core/extract/open_boundary.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/mesh/fans.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

/// The kept x-quads around a vertex, rising, and their fans.
struct KeptFans {
  std::vector<std::uint32_t> quads;
  Fans fans;
};

std::uint32_t find_fans(const QuadMesh& mesh, std::span<const std::uint32_t> new_quad, std::uint32_t vertex,
                        KeptFans& kept) {
  kept.quads.clear();
  kept.fans.clear();
  for (const std::uint32_t q : mesh.quads_of(vertex)) {
    if (new_quad[q] == kDropped) continue;
    const Polygon polygon = mesh.polygon(q);
    const int at = static_cast<int>(std::find(polygon.vertex.begin(), polygon.vertex.begin() + polygon.size, vertex) -
                                    polygon.vertex.begin());
    const auto side = [&](int i) { return polygon.vertex[static_cast<std::size_t>(i % polygon.size)]; };
    kept.quads.push_back(q);
    kept.fans.add(side(at + 1), side(at + polygon.size - 1));
  }
  return kept.fans.find();
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
  KeptFans kept;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t count = loses(v) ? find_fans(mesh, new_quad, v, kept) : 1;
    DUBSAR_CHECK(first[v] < kDropped - 13);
    first[v + 1] = first[v] + count;
  }

  QuadMesh opened;
  opened.embedded = mesh.embedded;
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
    find_fans(mesh, new_quad, v, kept);
    for (std::size_t i = 0; i < kept.quads.size(); ++i) {
      const std::uint32_t q = new_quad[kept.quads[i]];
      for (std::uint32_t& corner : opened.quads[q]) {
        if (corner == first[v]) corner = first[v] + kept.fans.of_corner()[i];
      }
      const auto range = std::equal_range(opened.doubled.begin(), opened.doubled.end(), DoubledCorner{q, 0, 0},
                                          [](const auto& a, const auto& b) { return a.quad < b.quad; });
      for (auto d = range.first; d != range.second; ++d) {
        if (d->vertex == first[v]) d->vertex = first[v] + kept.fans.of_corner()[i];
      }
    }
  }
  opened.build_incidence();
  return opened;
}

}  // namespace dubsar
