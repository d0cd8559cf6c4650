#pragma once
// Weighted sums of rows of an array, by vector instructions: what disks around all points of a block cost.

#include <cstdint>
#include <span>

namespace dubsar {

struct RowTap {
  std::int32_t away = 0;  ///< from the row that is summed, values
  float weight = 0.0f;
};
struct SummedRow {
  std::int32_t from = 0, to = 0;  ///< first value of the row
};
inline constexpr std::int32_t kRowLength = 16;  ///< values that are read and written of each row

/// to[row.to + i] = sum of weight * from[row.from + away + i] over the taps in their order, for i below kRowLength.
/// Rows that are written do not overlap. The same on every processor.
void sum_rows(const float* from, std::span<const RowTap> taps, std::span<const SummedRow> rows, float* to);

}  // namespace dubsar
