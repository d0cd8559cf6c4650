#pragma once
// Per-vertex and per-x-quad values in chunks of 65,536: which neighbours are known when one is coded.

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/system/parallel.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

inline constexpr std::int64_t kItemsPerChunk = 65536;
constexpr std::int64_t item_chunks(std::int64_t items) { return (items + kItemsPerChunk - 1) / kItemsPerChunk; }

/// Calls visit(w) for the neighbours w of vertex v with first <= w < v: for each incident x-quad in rising order the
/// vertex before v and the vertex behind it in the polygon.
template <class Visit>
void known_neighbours(const QuadMesh& mesh, std::uint32_t v, std::uint32_t first, const Visit& visit) {
  for (const std::uint32_t q : mesh.quads_of(v)) {
    if (!mesh.has_doubled(q)) {
      const auto& quad = mesh.quads[q];
      const std::uint32_t at = quad[0] == v ? 0 : quad[1] == v ? 1 : quad[2] == v ? 2 : 3;
      for (const std::uint32_t w : {quad[(at + 3) % 4], quad[(at + 1) % 4]})
        if (w >= first && w < v) visit(w);
      continue;
    }
    const Polygon polygon = mesh.polygon(q);
    int at = 0;
    while (polygon.vertex[static_cast<std::size_t>(at)] != v) ++at;
    for (const int side : {at + polygon.size - 1, at + 1}) {
      const std::uint32_t w = polygon.vertex[static_cast<std::size_t>(side % polygon.size)];
      if (w >= first && w < v) visit(w);
    }
  }
}

/// Calls visit(w, share) for the vertices w of the x-quads around v with first <= w < v, in rising x-quads and in the
/// order of the polygon from the one behind v on: share 2 for those beside v, 1 for the others. Polygons that share w
/// count each.
template <class Visit>
void known_surroundings(const QuadMesh& mesh, std::uint32_t v, std::uint32_t first, const Visit& visit) {
  for (const std::uint32_t q : mesh.quads_of(v)) {
    if (!mesh.has_doubled(q)) {
      const auto& quad = mesh.quads[q];
      const std::uint32_t at = quad[0] == v ? 0 : quad[1] == v ? 1 : quad[2] == v ? 2 : 3, known = v - first;
#pragma GCC unroll 3
      for (std::uint32_t step = 1; step < 4; ++step)
        if (const std::uint32_t w = quad[(at + step) % 4]; w - first < known) visit(w, step == 2 ? 1 : 2);
      continue;
    }
    const Polygon polygon = mesh.polygon(q);
    int at = 0;
    while (polygon.vertex[static_cast<std::size_t>(at)] != v) ++at;
    for (int step = 1; step < polygon.size; ++step)
      if (const std::uint32_t w = polygon.vertex[static_cast<std::size_t>((at + step) % polygon.size)];
          w >= first && w < v)
        visit(w, step == 1 || step + 1 == polygon.size ? 2 : 1);
  }
}

/// Would known_surroundings() visit any?
inline bool has_known_surroundings(const QuadMesh& mesh, std::uint32_t v, std::uint32_t first) {
  for (const std::uint32_t q : mesh.quads_of(v)) {
    if (!mesh.has_doubled(q)) {
      for (const std::uint32_t w : mesh.quads[q])
        if (w - first < v - first) return true;
      continue;
    }
    const Polygon polygon = mesh.polygon(q);
    for (int i = 0; i < polygon.size; ++i)
      if (polygon.vertex[static_cast<std::size_t>(i)] - first < v - first) return true;
  }
  return false;
}

/// Encodes chunks on all threads: encode(first, end) -> bytes.
template <class Encode>
std::vector<std::string> encode_item_chunks(std::int64_t items, Progress& progress, const Encode& encode) {
  std::vector<std::string> chunks(static_cast<std::size_t>(item_chunks(items)));
  parallel_for(static_cast<std::int64_t>(chunks.size()), 1, [&](std::int64_t c) {
    if (progress.cancelled()) return;
    const std::int64_t first = c * kItemsPerChunk,
                       end = first + kItemsPerChunk < items ? first + kItemsPerChunk : items;
    chunks[static_cast<std::size_t>(c)] = encode(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end));
  });
  return chunks;
}

}  // namespace dubsar
