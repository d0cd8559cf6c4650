// The cells of mixed sign of a row, once for each target of Highway: included behind <hwy/highway.h>.
#if defined(DUBSAR_MIXED_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUBSAR_MIXED_CELLS_INL_H
#undef DUBSAR_MIXED_CELLS_INL_H
#else
#define DUBSAR_MIXED_CELLS_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/extract/cell_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {

/// Appends first + i for each bit i of the word, rising; writes eight places at a time.
HWY_INLINE std::uint32_t* list_bits(std::uint64_t word, std::uint32_t first, std::uint32_t* to) {
  std::uint32_t* const end = to + __builtin_popcountll(word);
  do {  // eight at a time: how many there are cannot be foretold
    for (int i = 0; i < 8; ++i, word &= word - 1)
      to[i] = first + static_cast<std::uint32_t>(__builtin_ctzll(word | std::uint64_t{1} << 63));
    to += 8;
  } while (to < end);
  return end;
}

/// Calls visit(cells, count, signs) for blocks of the cells of the row whose corners are not all alike, in rising
/// order; signs(i) are the corners of cells[i] + first. Points outside the grid are outside.
template <class Visit>
HWY_INLINE void for_mixed_cells(const SurfaceSamples& samples, const CellRow& cells, const Visit& visit) {
  constexpr std::int64_t kBlock = 32;  // words
  static constexpr std::uint64_t kOutside = 0;
  const std::int64_t row_words = samples.signs.words_per_row(), words = samples.dims.x / 64 + 1;
  const std::uint64_t* row[4];
  std::int64_t within[4];  // all ones, or 0: one word serves for all
  for (int r = 0; r < 4; ++r) {
    const std::int64_t y = cells.j - 1 + r % 2, z = cells.k - 1 + r / 2;
    const bool inside = y >= 0 && z >= 0 && y < samples.dims.y && z < samples.dims.z;
    row[r] = inside ? samples.signs.row(y, z) : &kOutside;
    within[r] = inside ? -1 : 0;
  }
  std::uint64_t point[4][kBlock + 2];    // [0]: the word before the block; the last one is room for reads of two bytes
  std::uint32_t found[64 * kBlock + 8];  // from 64 on, in bits of `point`
  for (int r = 0; r < 4; ++r) point[r][0] = 0;
  std::uint64_t any_before = 0, all_before = 0;
  for (std::int64_t begin = 0; begin < words; begin += kBlock) {
    const std::int64_t size = std::min(kBlock, words - begin);
    std::uint32_t* end = found;
    for (std::int64_t w = 0; w < size; ++w) {
      std::uint64_t here[4];
      for (int r = 0; r < 4; ++r) {  // the last word may hold one cell and no point
        here[r] = begin + w < row_words ? row[r][(begin + w) & within[r]] : 0;
        point[r][w + 1] = here[r];
      }
      const std::uint64_t any = here[0] | here[1] | here[2] | here[3], all = here[0] & here[1] & here[2] & here[3];
      const std::uint64_t mixed = (any | any << 1 | any_before >> 63) & ~(all & (all << 1 | all_before >> 63));
      any_before = any;
      all_before = all;
      if (mixed != 0) end = list_bits(mixed, static_cast<std::uint32_t>(64 * (w + 1)), end);
    }
    const auto signs = [&](std::uint32_t bit) HWY_ATTR {
      const std::uint32_t before = bit - 1;  // of the point before the cell; the one behind it is the next
      const auto pair = [&](int r) HWY_ATTR {
        std::uint16_t bits;
        std::memcpy(&bits, reinterpret_cast<const unsigned char*>(point[r]) + before / 8, sizeof bits);
        return static_cast<unsigned>(bits) >> before % 8 & 3u;
      };
      return pair(0) | pair(1) << 2 | pair(2) << 4 | pair(3) << 6;
    };
    if (end != found) visit(std::span<const std::uint32_t>(found, end), 64 * (begin - 1), signs);
    for (int r = 0; r < 4; ++r) point[r][0] = point[r][kBlock];
  }
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DUBSAR_MIXED_CELLS_INL_H
