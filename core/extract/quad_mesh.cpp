#include "core/extract/quad_mesh.h"

#include <algorithm>
#include <atomic>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"

namespace dubsar {

Polygon QuadMesh::polygon(std::uint32_t quad) const noexcept {
  Polygon polygon;
  const auto& corners = quads[quad];
  if (!has_doubled(quad)) {
    polygon.size = 4;
    for (std::uint8_t c = 0; c < 4; ++c) {
      polygon.vertex[c] = corners[c];
      polygon.corner[c] = c;
    }
    return polygon;
  }
  auto next = std::lower_bound(doubled.begin(), doubled.end(), quad,
                               [](const DoubledCorner& d, std::uint32_t q) { return d.quad < q; });
  for (std::uint8_t c = 0; c < 4; ++c) {
    polygon.vertex[polygon.size] = corners[c];
    polygon.corner[polygon.size++] = c;
    if (next != doubled.end() && next->quad == quad && next->corner == c) {
      polygon.vertex[polygon.size] = next->vertex;
      polygon.corner[polygon.size++] = c;
      ++next;
    }
  }
  return polygon;
}

void QuadMesh::mark_doubled() {
  doubled_bits.assign((quads.size() + 63) / 64, 0);
  for (const DoubledCorner& d : doubled) doubled_bits[d.quad >> 6] |= std::uint64_t{1} << (d.quad & 63);
}

void QuadMesh::build_incidence() {
  mark_doubled();
  first_incident = {};
  resize_large(first_incident, positions.size() + 1);
  const auto for_each = [&](const auto& visit) {
    parallel_for(quad_count(), 1 << 14, [&](std::int64_t q) {
      for (const std::uint32_t v : quads[static_cast<std::size_t>(q)]) visit(v, static_cast<std::uint32_t>(q));
    });
    for (const DoubledCorner& d : doubled) visit(d.vertex, d.quad);
  };
  // first_incident[v] counts, then is the end of v's list while it is filled from behind, then its begin.
  for_each([&](std::uint32_t v, std::uint32_t) {
    std::atomic_ref(first_incident[v]).fetch_add(1, std::memory_order_relaxed);
  });
  std::uint32_t sum = 0;
  for (std::uint32_t& count : first_incident) count = sum += count;
  if (incident.capacity() < sum) incident = {};  // growing, it would take twice as much
  resize_large(incident, sum);
  for_each([&](std::uint32_t v, std::uint32_t q) {
    incident[std::atomic_ref(first_incident[v]).fetch_sub(1, std::memory_order_relaxed) - 1] = q;
  });
  parallel_for(vertex_count(), 1 << 14, [&](std::int64_t v) {
    std::sort(incident.begin() + first_incident[static_cast<std::size_t>(v)],
              incident.begin() + first_incident[static_cast<std::size_t>(v) + 1]);
  });
}

}  // namespace dubsar
