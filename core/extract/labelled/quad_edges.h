#pragma once
// The grid edge of each x-quad: where in the grid a mesh lies.

#include <bit>
#include <cstdint>

#include "core/base/system/parallel.h"
#include "core/extract/edge_index.h"
#include "core/extract/labelled/contact_edges.h"
#include "core/extract/row_kernels.h"

namespace dubsar {

/// visit(quad, edge) of each x-quad of build_quad_mesh() of closed samples, each once. All threads, for those inside
/// the grid.
template <class Visit>
void each_quad_edge(const BitVolume& signs, const EdgeIndex& index, const Visit& visit) {
  const Dims& dims = signs.dims();
  const std::int64_t words = signs.words_per_row();
  const auto edge = [](std::int64_t x, std::int64_t y, std::int64_t z, int axis) {
    return GridEdge{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z), axis};
  };
  parallel_for(dims.y * dims.z, rows_per_chunk(dims.x), [&](std::int64_t r) {
    const std::int64_t y = r % dims.y, z = r / dims.y;
    const std::uint64_t* here = signs.row(y, z);
    for (int axis = 0; axis < 3; ++axis) {
      if ((axis == 1 && y + 1 == dims.y) || (axis == 2 && z + 1 == dims.z)) continue;
      const std::uint64_t* there = signs.row(y + (axis == 1), z + (axis == 2));
      std::uint32_t quad = index.starts(y, z).edges[static_cast<std::size_t>(axis)];
      for (std::int64_t w = 0; w < words; ++w) {
        std::uint64_t next = there[w];
        if (axis == 0) next = here[w] >> 1 | (w + 1 < words ? here[w + 1] << 63 : 0);
        std::uint64_t active = here[w] ^ next;
        if (axis == 0 && w + 1 == words) active &= ~(std::uint64_t{1} << ((dims.x - 1) & 63));
        for (; active != 0; active &= active - 1) visit(quad++, edge(64 * w + std::countr_zero(active), y, z, axis));
      }
    }
  });
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y) {
      const bool all_x = y == 0 || z == 0 || y + 1 == dims.y || z + 1 == dims.z;
      for (std::int64_t x = 0; x < dims.x; x += all_x || dims.x == 1 ? 1 : dims.x - 1) {
        if (!signs.get(x, y, z)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const std::int64_t bx = x - (axis == 0), by = y - (axis == 1), bz = z - (axis == 2);
          if (bx < 0 || by < 0 || bz < 0) visit(index.quad_of(axis, bx, by, bz), edge(bx, by, bz, axis));
          if (index.is_virtual(axis, x, y, z)) visit(index.quad_of(axis, x, y, z), edge(x, y, z, axis));
        }
      }
    }
}

}  // namespace dubsar
