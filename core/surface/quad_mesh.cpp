#include "core/surface/quad_mesh.h"

#include <algorithm>

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

void QuadMesh::build_incidence() {
  doubled_bits.assign((quads.size() + 63) / 64, 0);
  for (const DoubledCorner& d : doubled) doubled_bits[d.quad >> 6] |= std::uint64_t{1} << (d.quad & 63);
  first_incident.assign(positions.size() + 1, 0);
  const auto for_each = [&](const auto& visit) {
    auto next = doubled.begin();
    for (std::uint32_t q = 0; q < quads.size(); ++q) {
      for (const std::uint32_t v : quads[q]) visit(v, q);
      for (; next != doubled.end() && next->quad == q; ++next) visit(next->vertex, q);
    }
  };
  for_each([&](std::uint32_t v, std::uint32_t) { ++first_incident[v + 1]; });
  for (std::size_t v = 0; v < positions.size(); ++v) first_incident[v + 1] += first_incident[v];
  incident.resize(first_incident.back());
  std::vector<std::uint32_t> fill(first_incident.begin(), first_incident.end() - 1);
  for_each([&](std::uint32_t v, std::uint32_t q) { incident[fill[v]++] = q; });
}

}  // namespace dubsar
