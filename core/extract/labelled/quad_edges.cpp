#include "core/extract/labelled/quad_edges.h"

#include <bit>

#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/extract/row_kernels.h"

namespace dubsar {

std::vector<GridEdge> edges_of_quads(const BitVolume& signs, const EdgeIndex& index) {
  const Dims& dims = signs.dims();
  std::vector<GridEdge> edges(static_cast<std::size_t>(index.counts().edges + index.virtual_edges()));
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
      std::size_t quad = index.starts(y, z).edges[static_cast<std::size_t>(axis)];
      for (std::int64_t w = 0; w < words; ++w) {
        std::uint64_t next = there[w];
        if (axis == 0) next = here[w] >> 1 | (w + 1 < words ? here[w + 1] << 63 : 0);
        std::uint64_t active = here[w] ^ next;
        if (axis == 0 && w + 1 == words) active &= ~(std::uint64_t{1} << ((dims.x - 1) & 63));
        for (; active != 0; active &= active - 1) edges[quad++] = edge(64 * w + std::countr_zero(active), y, z, axis);
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
          if (bx < 0 || by < 0 || bz < 0) edges[index.quad_of(axis, bx, by, bz)] = edge(bx, by, bz, axis);
          if (index.is_virtual(axis, x, y, z)) edges[index.quad_of(axis, x, y, z)] = edge(x, y, z, axis);
        }
      }
    }
  return edges;
}

std::vector<glm::ivec3> cells_of_vertices(const QuadMesh& mesh, const std::vector<GridEdge>& edges,
                                          const std::vector<bool>& reversed) {
  DUBSAR_CHECK(edges.size() == mesh.quads.size() && reversed.size() == edges.size());
  std::vector<glm::ivec3> cells(mesh.positions.size(), glm::ivec3(0));
  const auto cell_at = [&](std::size_t quad, unsigned corner) {
    // Corners 1 and 3 change places where the polygon runs the other way.
    constexpr std::array<std::array<int, 2>, 4> kBack = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const GridEdge& e = edges[quad];
    const auto& [u, v] = kBack[reversed[quad] ? (4 - corner) % 4 : corner];
    glm::ivec3 cell(e.x, e.y, e.z);
    cell[(e.axis + 1) % 3] -= u;
    cell[(e.axis + 2) % 3] -= v;
    return cell;
  };
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (unsigned c = 0; c < 4; ++c) cells[mesh.quads[q][c]] = cell_at(q, c);
  for (const DoubledCorner& d : mesh.doubled) cells[d.vertex] = cell_at(d.quad, d.corner);
  return cells;
}

}  // namespace dubsar
