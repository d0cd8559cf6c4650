// The first half of extraction: one pass over the volume, in slabs, two neighbouring slices at a time.
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/system/budget.h"
#include "core/base/system/parallel.h"
#include "core/extract/extract.h"
#include "core/extract/row_kernels.h"

namespace dubsar {
namespace {

/// Slices per slab, so that a slab stays in the cache between reading and packing.
std::int64_t slab_height(const Dims& dims) {
  constexpr std::int64_t kSlabBytes = 4 << 20;
  return std::clamp<std::int64_t>(kSlabBytes / (dims.slice() * std::int64_t{sizeof(float)}), 1, dims.z);
}

}  // namespace

Result<SurfaceSamples> sample_surface(SlabSource& source, const ExtractOptions& options, Progress& progress) {
  const Dims dims = source.dims();
  if (dims.x < 1 || dims.y < 1 || dims.z < 1) {
    return fail(ErrorKind::kBadData,
                "extract: a volume of {}x{}x{} points found, at least one along each axis expected", dims.x, dims.y,
                dims.z);
  }
  if (options.offset_bits < 1 || options.offset_bits > 16) {
    return fail(ErrorKind::kUsage, "extract: {} offset bits asked for, 1 to 16 expected", options.offset_bits);
  }
  if (!std::isfinite(options.isovalue)) {
    return fail(ErrorKind::kUsage, "extract: the isovalue is {}, a finite number expected", options.isovalue);
  }
  const std::int64_t height = options.slab > 0 ? std::min(options.slab, dims.z) : slab_height(dims);
  const std::int64_t words = (dims.x + 63) / 64;
  DUBSAR_TRY(check_memory("the surface samples", static_cast<std::uint64_t>(words * dims.y * dims.z) * 8 +
                                                     static_cast<std::uint64_t>((height + 1) * dims.slice()) * 4));

  SurfaceSamples samples;
  samples.dims = dims;
  samples.isovalue = options.isovalue;
  samples.offset_bits = options.offset_bits;
  samples.closed = options.closed;
  samples.signs = BitVolume(dims);
  Buffer<float> values((height + 1) * dims.slice());  // the last slice of the slab before, then this slab
  std::vector<RowItems> items;
  std::vector<std::int64_t> edge_start, face_start;

  for (std::int64_t z = 0; z < dims.z; z += height) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t end = std::min(dims.z, z + height);
    const std::int64_t slab = (end - z) * dims.slice();
    DUBSAR_TRY(source.read(
        z, end, values.span().subspan(static_cast<std::size_t>(dims.slice()), static_cast<std::size_t>(slab))));
    const auto value_row = [&](std::int64_t row_y, std::int64_t row_z) {
      return values.data() + (row_z - z + 1) * dims.slice() + row_y * dims.x;
    };
    parallel_for((end - z) * dims.y, rows_per_chunk(dims.x), [&](std::int64_t r) {
      const std::int64_t y = r % dims.y, row_z = z + r / dims.y;
      pack_signs(value_row(y, row_z), dims.x, options.isovalue, samples.signs.row(y, row_z));
    });

    // Rows whose neighbour above is known now; in the last slab also those that have none.
    const std::int64_t first = std::max<std::int64_t>(z - 1, 0), last = end == dims.z ? end : end - 1;
    const std::int64_t rows = (last - first) * dims.y;
    items.assign(static_cast<std::size_t>(rows), {});
    edge_start.assign(static_cast<std::size_t>(rows), 0);
    face_start.assign(static_cast<std::size_t>(rows), 0);
    const auto sign_rows = [&](std::int64_t y, std::int64_t row_z) {
      const bool has_y = y + 1 < dims.y, has_z = row_z + 1 < dims.z;
      return SignRows{samples.signs.row(y, row_z), has_y ? samples.signs.row(y + 1, row_z) : nullptr,
                      has_z ? samples.signs.row(y, row_z + 1) : nullptr,
                      has_y && has_z ? samples.signs.row(y + 1, row_z + 1) : nullptr};
    };
    parallel_for(rows, rows_per_chunk(dims.x), [&](std::int64_t r) {
      const auto i = static_cast<std::size_t>(r);
      items[i] = count_row(sign_rows(r % dims.y, first + r / dims.y), dims.x);
      edge_start[i] = std::int64_t{items[i].edges[0]} + items[i].edges[1] + items[i].edges[2];
      face_start[i] = std::int64_t{items[i].faces[0]} + items[i].faces[1] + items[i].faces[2];
    });
    const std::size_t edges_before = samples.offsets.size(), faces_before = samples.joined.size();
    const std::int64_t edges = exclusive_scan(edge_start);
    samples.offsets.resize(edges_before + static_cast<std::size_t>(edges));
    samples.joined.resize(faces_before + static_cast<std::size_t>(exclusive_scan(face_start)));
    parallel_chunks(rows, rows_per_chunk(dims.x), [&](std::int64_t begin, std::int64_t rows_end) {
      const auto start_of = [&](std::int64_t r) { return r == rows ? edges : edge_start[static_cast<std::size_t>(r)]; };
      const std::int64_t first_edge = start_of(begin), chunk_edges = start_of(rows_end) - first_edge;
      const std::unique_ptr<EdgeEnds[]> ends(new EdgeEnds[static_cast<std::size_t>(chunk_edges)]);
      for (std::int64_t r = begin; r < rows_end; ++r) {
        if (start_of(r) == start_of(r + 1)) continue;
        const auto i = static_cast<std::size_t>(r);
        const std::int64_t y = r % dims.y, row_z = first + r / dims.y;
        const bool has_y = y + 1 < dims.y, has_z = row_z + 1 < dims.z;
        const ValueRows value_rows{value_row(y, row_z), has_y ? value_row(y + 1, row_z) : nullptr,
                                   has_z ? value_row(y, row_z + 1) : nullptr,
                                   has_y && has_z ? value_row(y + 1, row_z + 1) : nullptr};
        fill_row(sign_rows(y, row_z), value_rows, dims.x, options.isovalue, items[i],
                 ends.get() + (edge_start[i] - first_edge), samples.joined.data() + faces_before + face_start[i]);
      }
      quantise_crossings(ends.get(), static_cast<std::size_t>(chunk_edges), options.isovalue, options.offset_bits,
                         samples.offsets.data() + edges_before + first_edge);
    });
    if (end < dims.z) std::copy_n(value_row(0, end - 1), dims.slice(), values.data());
    progress.advance(slab);
  }
  return samples;
}

}  // namespace dubsar
