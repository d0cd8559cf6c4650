// The second half of extraction: count, prefix sums, write at final places. Every cell writes its vertices and its own
// corners of the x-quads around its active edges, so that no adjacency is searched and nothing depends on threads.
#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>

#include "core/base/system/budget.h"
#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/extract/cell_kernels.h"
#include "core/extract/extract.h"
#include "core/extract/open_boundary.h"
#include "core/extract/row_kernels.h"

namespace dubsar {
namespace {

constexpr std::int64_t kMaxVertices = std::int64_t{std::numeric_limits<std::uint32_t>::max()} - 1;

/// All chunks by (quad, corner): into buckets of 64 x-quads, few in each, which are then sorted.
std::vector<DoubledCorner> sorted_corners(const std::vector<std::vector<DoubledCorner>>& chunks, std::int64_t quads) {
  std::vector<std::uint32_t> place(static_cast<std::size_t>(quads / 64 + 2), 0);
  for (const auto& chunk : chunks)
    for (const DoubledCorner& d : chunk) ++place[d.quad / 64 + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<DoubledCorner> sorted(place.back());
  for (const auto& chunk : chunks)
    for (const DoubledCorner& d : chunk) sorted[place[d.quad / 64]++] = d;
  const auto before = [](const DoubledCorner& a, const DoubledCorner& b) {
    return a.quad != b.quad ? a.quad < b.quad : a.corner < b.corner;
  };
  for (std::size_t b = 0, begin = 0; b + 1 < place.size(); begin = place[b++])
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin), sorted.begin() + place[b], before);
  return sorted;
}

}  // namespace

Result<QuadMesh> build_quad_mesh(const SurfaceSamples& samples, Progress& progress) {
  DUBSAR_TRY(check_signs(samples));
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(samples));
  return build_quad_mesh(samples, index, progress);
}

Result<QuadMesh> build_quad_mesh(const SurfaceSamples& samples, const EdgeIndex& index, Progress& progress) {
  DUBSAR_TRY(check_samples(samples, index.counts()));
  const Dims& dims = samples.dims;
  const std::int64_t grain = rows_per_chunk(dims.x);
  const std::int64_t rows_y = dims.y + 1, rows = rows_y * (dims.z + 1);
  const auto row_of = [&](std::int64_t r) { return CellRow{r % rows_y, r / rows_y}; };
  std::atomic<std::int64_t> done{0};
  const auto advance = [&](std::int64_t cell_rows) {
    // Half of the voxels for counting, half for writing; the sum of the steps is exactly the number of voxels.
    const auto voxels = [&](std::int64_t r) { return r * dims.count() / (2 * rows); };
    const std::int64_t before = done.fetch_add(cell_rows);
    progress.advance(voxels(before + cell_rows) - voxels(before));
  };

  std::vector<CellRowCounts> counts(static_cast<std::size_t>(rows) + 1);
  std::vector<CellList> listed(static_cast<std::size_t>((rows + grain - 1) / grain));
  parallel_chunks(rows, grain, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    CellList& list = listed[static_cast<std::size_t>(begin / grain)];
    for (std::int64_t r = begin; r < end; ++r) {
      counts[static_cast<std::size_t>(r)] = list_cells(samples, index, row_of(r), list);
    }
    advance(end - begin);
  });
  if (progress.cancelled()) return cancelled_error();
  std::int64_t vertices = 0, incidences = 0;
  for (CellRowCounts& row : counts) {
    const CellRowCounts here = row;
    row = {here.cells, static_cast<std::uint32_t>(vertices), static_cast<std::uint32_t>(incidences)};
    vertices += here.vertices;
    incidences += here.incidences;
  }
  if (vertices > kMaxVertices || incidences > kMaxVertices) {
    return fail(ErrorKind::kTryAgain,
                "extract: the surface has {} vertices and {} incidences, at most {} can be numbered: choose another "
                "isovalue, denoise or crop the volume",
                vertices, incidences, kMaxVertices);
  }
  const std::int64_t quads = index.counts().edges + index.virtual_edges();
  DUBSAR_TRY(check_memory("the dual mesh", static_cast<std::uint64_t>(vertices) * 16 +
                                               static_cast<std::uint64_t>(quads) * 16 +
                                               static_cast<std::uint64_t>(incidences) * 4));

  QuadMesh mesh;
  mesh.embedded = true;
  parallel_for(3, 1, [&](std::int64_t part) {  // page faults are half of the cost of memory
    if (part == 0) resize_large(mesh.quads, static_cast<std::size_t>(quads));
    if (part == 1) resize_large(mesh.incident, static_cast<std::size_t>(incidences));
    if (part != 2) return;
    resize_large(mesh.positions, static_cast<std::size_t>(vertices));
    resize_large(mesh.first_incident, static_cast<std::size_t>(vertices) + 1);
    mesh.first_incident.back() = static_cast<std::uint32_t>(incidences);
  });
  std::vector<std::uint8_t> in_layer(samples.closed ? 0 : static_cast<std::size_t>(vertices));
  std::vector<std::vector<DoubledCorner>> doubled(listed.size());
  parallel_chunks(rows, grain, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    const CellList list = std::move(listed[static_cast<std::size_t>(begin / grain)]);
    std::size_t cells = 0;
    CellRowOutput output;
    output.mesh = &mesh;
    output.doubled = &doubled[static_cast<std::size_t>(begin / grain)];
    output.in_layer = samples.closed ? nullptr : &in_layer;
    for (std::int64_t r = begin; r < end; ++r) {
      const CellRowCounts& start = counts[static_cast<std::size_t>(r)];
      const CellRowCounts& next = counts[static_cast<std::size_t>(r) + 1];
      if (start.cells == 0) continue;
      output.first_vertex = start.vertices;
      output.first_incidence = start.incidences;
      output.end_incidence = next.incidences;
      const ListedRow row{std::span(list.cell).subspan(cells, start.cells),
                          std::span(list.config).subspan(cells, start.cells)};
      cells += start.cells;
      write_cells(samples, index, row_of(r), row, output);
    }
    advance(end - begin);
  });
  if (progress.cancelled()) return cancelled_error();

  mesh.doubled = sorted_corners(doubled, quads);
  mesh.mark_doubled();
  if (samples.closed) return mesh;
  return open_at_boundary(mesh, in_layer);
}

}  // namespace dubsar
