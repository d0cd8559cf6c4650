#pragma once
// What the encoder knows of a brick: its signs and which of its cells have both signs inside.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/exa/signs/bit_spread.h"
#include "core/exa/signs/sign_bricks.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

/// Beyond the end the last slice is repeated.
inline bool sign_at(const BitVolume& signs, std::int64_t x, std::int64_t y, std::int64_t z) {
  const Dims& d = signs.dims();
  return signs.get(std::min(x, d.x - 1), std::min(y, d.y - 1), std::min(z, d.z - 1));
}

/// With words of cells of spacing 2, 4, 8.
class BrickTruth {
 public:
  BrickTruth(const BitVolume& signs, const Brick& brick) : signs_(signs), brick_(brick) {
    std::array<int, 3> n{brick.cells[0] / 2, brick.cells[1] / 2, brick.cells[2] / 2};
    for (std::size_t level = 1; level <= 3; ++level) {
      cells_[level] = n;
      mixed_[level].assign(static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]), 0);
      for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y) mixed_[level][row(level, y, z)] = level == 1 ? pairs(y, z) : halves(level, y, z);
      for (int& c : n) c /= 2;
    }
  }
  bool sign(int x, int y, int z) const {
    return sign_at(signs_, brick_.low[0] + x, brick_.low[1] + y, brick_.low[2] + z);
  }
  bool mixed(int level, int x, int y, int z) const {
    const auto l = static_cast<std::size_t>(level);
    return mixed_[l][row(l, y, z)] >> x & 1;
  }
  bool any() const {
    return std::any_of(mixed_[3].begin(), mixed_[3].end(), [](std::uint64_t word) { return word != 0; });
  }

 private:
  std::size_t row(std::size_t level, int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_[level][1]) + static_cast<std::size_t>(y);
  }
  /// 129 points of a row: the words that it starts with and the last point.
  struct RowBits {
    std::uint64_t low = 0, high = 0;
    bool last = false;
  };
  RowBits row_bits(int y, int z) const {
    const Dims& d = signs_.dims();
    const std::uint64_t* words = signs_.row(std::min(brick_.low[1] + y, d.y - 1), std::min(brick_.low[2] + z, d.z - 1));
    const std::int64_t first = brick_.low[0] / 64, count = signs_.words_per_row(), points = d.x - brick_.low[0];
    RowBits bits;
    if (points >= 129) return {words[first], words[first + 1], (words[first + 2] & 1) != 0};
    bits.low = words[first];
    if (first + 1 < count) bits.high = words[first + 1];
    bits.last = signs_.get(d.x - 1, std::min(brick_.low[1] + y, d.y - 1), std::min(brick_.low[2] + z, d.z - 1));
    if (!bits.last) return bits;
    if (points < 64) bits.low |= ~std::uint64_t{0} << points;
    if (points <= 64)
      bits.high = ~std::uint64_t{0};
    else if (points < 128)
      bits.high |= ~std::uint64_t{0} << (points - 64);
    return bits;
  }
  std::uint64_t pairs(int y, int z) const {
    RowBits any, all{~std::uint64_t{0}, ~std::uint64_t{0}, true};
    for (int p = 0; p < 9; ++p) {
      const RowBits bits = row_bits(2 * y + p % 3, 2 * z + p / 3);
      any = {any.low | bits.low, any.high | bits.high, any.last || bits.last};
      all = {all.low & bits.low, all.high & bits.high, all.last && bits.last};
    }
    const auto three = [](std::uint64_t w, bool next, auto join) {  // bit i with bits i + 1 and i + 2
      return join(join(w, w >> 1), w >> 2 | std::uint64_t{next} << 62);
    };
    const auto both = [](std::uint64_t a, std::uint64_t b) { return a & b; };
    const auto either = [](std::uint64_t a, std::uint64_t b) { return a | b; };
    const std::uint64_t low = three(any.low, any.high & 1, either) & ~three(all.low, all.high & 1, both);
    const std::uint64_t high = three(any.high, any.last, either) & ~three(all.high, all.last, both);
    const std::uint64_t mixed = even_bits(low) | even_bits(high) << 32;
    const int n = cells_[1][0];
    return n >= 64 ? mixed : mixed & ((std::uint64_t{1} << n) - 1);
  }
  std::uint64_t halves(std::size_t level, int y, int z) const {
    std::uint64_t any = 0;
    for (int p = 0; p < 4; ++p) any |= mixed_[level - 1][row(level - 1, 2 * y + p % 2, 2 * z + p / 2)];
    return even_bits(any | any >> 1);
  }

  const BitVolume& signs_;
  Brick brick_;
  std::array<std::array<int, 3>, 4> cells_{};
  std::array<std::vector<std::uint64_t>, 4> mixed_;
};

}  // namespace dubsar
