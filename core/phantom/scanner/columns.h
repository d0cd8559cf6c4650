#pragma once
// Grids whose last axis is contiguous: a volume by its columns along z, a projection by its columns of pixels.

#include <algorithm>
#include <cstdint>

#include "core/volume/volume.h"

namespace dubsar::phantom {

/// Planes of `columns` columns of `rows` numbers. A column begins at a multiple of 16 floats; behind the last one stand
/// kGuard zeros, so that kernels may read whole vectors past the end of a column.
struct Columns {
  static constexpr std::int64_t kGuard = 64;
  std::int64_t planes = 0, columns = 0, rows = 0, stride = 0;
  Buffer<float> values;

  Columns() = default;
  Columns(std::int64_t plane_count, std::int64_t column_count, std::int64_t row_count)
      : planes(plane_count),
        columns(column_count),
        rows(row_count),
        stride(padded(row_count)),
        values(plane_count * column_count * stride + kGuard) {
    std::fill_n(values.data() + plane_count * column_count * stride, kGuard, 0.0f);
  }
  static constexpr std::int64_t padded(std::int64_t row_count) { return (row_count + 1 + 15) / 16 * 16; }
  float* at(std::int64_t plane, std::int64_t column) noexcept {
    return values.data() + (plane * columns + column) * stride;
  }
  const float* at(std::int64_t plane, std::int64_t column) const noexcept {
    return values.data() + (plane * columns + column) * stride;
  }
  void clear() noexcept { std::fill_n(values.data(), values.size(), 0.0f); }
};

}  // namespace dubsar::phantom
