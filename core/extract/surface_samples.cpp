#include "core/extract/surface_samples.h"

#include <algorithm>

#include "core/base/system/parallel.h"
#include "core/extract/row_kernels.h"

namespace dubsar {

SampleCounts count_samples(const BitVolume& signs) {
  const Dims& dims = signs.dims();
  return parallel_reduce<SampleCounts>(
      dims.y * dims.z, rows_per_chunk(dims.x), {},
      [&](std::int64_t begin, std::int64_t end) {
        SampleCounts sum;
        for (std::int64_t r = begin; r < end; ++r) {
          const std::int64_t y = r % dims.y, z = r / dims.y;
          const bool has_y = y + 1 < dims.y, has_z = z + 1 < dims.z;
          const RowItems items =
              count_row({signs.row(y, z), has_y ? signs.row(y + 1, z) : nullptr, has_z ? signs.row(y, z + 1) : nullptr,
                         has_y && has_z ? signs.row(y + 1, z + 1) : nullptr},
                        dims.x);
          for (std::size_t a = 0; a < 3; ++a) {
            sum.edges += items.edges[a];
            sum.faces += items.faces[a];
          }
        }
        return sum;
      },
      [](SampleCounts a, const SampleCounts& b) {
        return SampleCounts{a.edges + b.edges, a.faces + b.faces};
      });
}

double share_inside_at_border(const BitVolume& signs) {
  const Dims d = signs.dims();
  std::int64_t inside = 0, all = 0;
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y) {
      const bool whole_row = z == 0 || y == 0 || z + 1 == d.z || y + 1 == d.y;
      const std::int64_t step = whole_row ? 1 : std::max<std::int64_t>(1, d.x - 1);
      for (std::int64_t x = 0; x < d.x; x += step) {
        inside += signs.get(x, y, z) ? 1 : 0;
        ++all;
      }
    }
  return all == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(all);
}

Result<void> check_signs(const SurfaceSamples& samples) {
  const Dims& dims = samples.dims;
  if (dims.x < 1 || dims.y < 1 || dims.z < 1 || samples.signs.dims() != dims) {
    return fail(ErrorKind::kBadData,
                "surface samples: signs of {}x{}x{} points found, {}x{}x{} expected, at least one along each axis",
                samples.signs.dims().x, samples.signs.dims().y, samples.signs.dims().z, dims.x, dims.y, dims.z);
  }
  if (samples.offset_bits < 1 || samples.offset_bits > 16) {
    return fail(ErrorKind::kBadData, "surface samples: offsets of {} bits found, 1 to 16 expected",
                samples.offset_bits);
  }
  if (dims.x % 64 != 0) {
    const std::uint64_t padding = ~std::uint64_t{0} << (dims.x % 64);
    const std::uint64_t set = parallel_reduce<std::uint64_t>(
        dims.y * dims.z, 1024, 0,
        [&](std::int64_t begin, std::int64_t end) {
          std::uint64_t found = 0;
          for (std::int64_t r = begin; r < end; ++r) {
            found |= samples.signs.row(r % dims.y, r / dims.y)[dims.x / 64] & padding;
          }
          return found;
        },
        [](std::uint64_t x, std::uint64_t y) { return x | y; });
    if (set != 0) return fail(ErrorKind::kBadData, "surface samples: padding bits of the signs are set, expected 0");
  }
  return {};
}

Result<void> check_samples(const SurfaceSamples& samples, const SampleCounts& counts) {
  DUBSAR_TRY(check_signs(samples));
  if (counts.edges != static_cast<std::int64_t>(samples.offsets.size())) {
    return fail(ErrorKind::kBadData, "surface samples: {} offsets found, the signs have {} active edges",
                samples.offsets.size(), counts.edges);
  }
  if (counts.faces != static_cast<std::int64_t>(samples.joined.size())) {
    return fail(ErrorKind::kBadData, "surface samples: {} face decisions found, the signs have {} ambiguous faces",
                samples.joined.size(), counts.faces);
  }
  const auto largest = [](const auto& values) {
    return parallel_reduce<int>(
        static_cast<std::int64_t>(values.size()), 1 << 20, 0,
        [&](std::int64_t begin, std::int64_t end) {
          auto most = values[static_cast<std::size_t>(begin)];
          for (std::int64_t i = begin; i < end; ++i) most = std::max(most, values[static_cast<std::size_t>(i)]);
          return static_cast<int>(most);
        },
        [](int a, int b) { return std::max(a, b); });
  };
  if (const int offset = largest(samples.offsets); offset >= 1 << samples.offset_bits) {
    return fail(ErrorKind::kBadData, "surface samples: offset {} found, less than {} expected", offset,
                1 << samples.offset_bits);
  }
  if (const int joined = largest(samples.joined); joined > 1) {
    return fail(ErrorKind::kBadData, "surface samples: face decision {} found, 0 or 1 expected", joined);
  }
  return {};
}

}  // namespace dubsar
