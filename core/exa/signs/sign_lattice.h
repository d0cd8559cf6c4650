#pragma once
// Signs of a brick on one lattice, with a border in which the brick is mirrored or the bricks beside it continue, so
// that the surroundings of a point are read without looking where the brick ends.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/exa/signs/bit_spread.h"

namespace dubsar {

class SignLattice {
 public:
  static constexpr int kReach = 3;  ///< the border is as wide as the window of the model

  SignLattice() = default;
  /// `cells` along each axis, at most 128; points 0..cells. All signs are 0. `open`: bit 2 axis + (0 low, 1 high): on
  /// this side another brick is known (sign_surroundings.h), whose signs stand in the border instead of the mirror.
  explicit SignLattice(const std::array<int, 3>& cells, unsigned open = 0)
      : cells_(cells),
        open_(open),
        plane_((cells[1] + 1 + 2 * kReach) * kRowBytes),
        bytes_(static_cast<std::size_t>((cells[2] + 1 + 2 * kReach) * plane_ + 2 * kRowBytes)) {}

  const std::array<int, 3>& cells() const noexcept { return cells_; }
  unsigned open_sides() const noexcept { return open_; }
  bool open(std::size_t axis, int side) const noexcept { return open_ >> (2 * axis + static_cast<unsigned>(side)) & 1; }
  bool get(int x, int y, int z) const noexcept { return row(y, z)[(x + 8) >> 3] >> (x & 7) & 1; }
  /// Sets a sign to 1, here and in the mirror. A place outside the brick, up to 3 away, mirrors the point at the same
  /// distance on the other side of the border, if the brick has it, and otherwise is 0.
  void set(int x, int y, int z) noexcept {
    set_row(x, y, z);
    if (inner(y, 1) && inner(z, 2)) return;
    for (const int my : mirrors(y, 1))
      for (const int mz : mirrors(z, 2))
        if (my != kNone && mz != kNone && (my != y || mz != z)) set_row(x, my, mz);
  }
  /// Sets a whole row, bits 0..cells of `signs`; mirror() must follow before anything is read outside.
  void assign_row(int y, int z, const std::array<std::uint64_t, 3>& signs) noexcept {
    // Bit x stands at x + 8, so that 129 signs and the border fill three words.
    std::array<std::uint64_t, 3> words{signs[0] << 8, signs[1] << 8 | signs[0] >> 56, signs[2] << 8 | signs[1] >> 56};
    std::memcpy(bytes_.data() + offset(y, z), words.data(), sizeof words);
    for (const int x : {1, 2, 3, cells_[0] - 3, cells_[0] - 2, cells_[0] - 1})
      if (x >= 1 && x < cells_[0] && get(x, y, z)) set_row(x, y, z);
    if (cells_[0] <= kReach && get(cells_[0], y, z)) set_row(cells_[0], y, z);
    if (cells_[0] <= kReach && get(0, y, z)) set_row(0, y, z);
  }
  /// Sets the signs of x = -3..0 of a row, in this order from bit 0 on; of x = cells..cells + 3.
  void assign_low(int y, int z, std::uint64_t signs) noexcept { assign_four(y, z, -kReach, signs); }
  void assign_high(int y, int z, std::uint64_t signs) noexcept { assign_four(y, z, cells_[0], signs); }
  /// Sets signs of a row that bits x + 8 of three words say to 1, and their mirrors.
  void merge(int y, int z, const std::array<std::uint64_t, 3>& words) noexcept {
    if (inner(y, 1) && inner(z, 2)) {
      unsigned char* at = bytes_.data() + offset(y, z);
      for (std::size_t w = 0; w < 3; ++w) {
        const std::uint64_t word = load(at + 8 * w) | words[w];
        std::memcpy(at + 8 * w, &word, sizeof word);
      }
      for (const int x : {1, 2, 3, cells_[0] - 3, cells_[0] - 2, cells_[0] - 1})
        if (words[static_cast<std::size_t>((x + 8) >> 6)] >> ((x + 8) & 63) & 1) set_row(x, y, z);
      return;
    }
    for (std::size_t w = 0; w < 3; ++w)
      for (std::uint64_t rest = words[w]; rest != 0; rest &= rest - 1)
        set(static_cast<int>(64 * w) + std::countr_zero(rest) - 8, y, z);
  }
  /// Could a sign of this row, once set, be seen again in the mirror by later points of the row?
  bool mirrors_itself(int y, int z) const noexcept {
    return y < 2 || z < 2 || y > cells_[1] - 2 || z > cells_[2] - 2 || cells_[0] <= 2 * kReach;
  }
  /// Fills the border from rows set by assign_row(), where no other brick is known.
  void mirror() noexcept {
    for (int z = -kReach; z <= cells_[2] + kReach; ++z)
      mirror_axis(
          1, [&](int y) { return bytes_.data() + offset(y, z); }, kRowBytes);
    const std::size_t bytes = static_cast<std::size_t>(plane_);
    mirror_axis(
        2, [&](int z) { return bytes_.data() + offset(-kReach, z); }, static_cast<std::ptrdiff_t>(bytes));
  }
  /// The row of points (y, z): bit x + 8, lowest bit of a byte first.
  const unsigned char* row(int y, int z) const noexcept { return bytes_.data() + offset(y, z); }
  /// 64 signs of a row from x = 0, 64 or 128 on; what lies beyond the border is 0 or the mirror.
  std::uint64_t word(int y, int z, int from = 0) const noexcept { return load(row(y, z) + 1 + from / 8); }
  /// Signs 1..64 of a row.
  std::uint64_t next_word(int y, int z) const noexcept { return word(y, z) >> 1 | std::uint64_t{row(y, z)[9]} << 63; }
  /// Edges between points of different sign.
  std::uint64_t active_edges() const noexcept {
    std::uint64_t edges = 0;
    const auto count = [&edges](std::uint64_t apart, int points) {
      const std::uint64_t mask = points >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << points) - 1;
      edges += count_ones_of(apart & mask);
    };
    for (int z = 0; z <= cells_[2]; ++z)
      for (int y = 0; y <= cells_[1]; ++y)
        for (int x = 0; x <= cells_[0]; x += 64) {
          const std::uint64_t here = word(y, z, x);
          if (x < cells_[0]) count(here ^ (here >> 1 | word(y, z, x + 64) << 63), cells_[0] - x);
          if (y < cells_[1]) count(here ^ word(y + 1, z, x), cells_[0] + 1 - x);
          if (z < cells_[2]) count(here ^ word(y, z + 1, x), cells_[0] + 1 - x);
        }
    return edges;
  }
  /// From a row to the one (dy, dz) further.
  std::ptrdiff_t step(int dy, int dz) const noexcept { return dz * plane_ + dy * kRowBytes; }

 private:
  static constexpr std::ptrdiff_t kRowBytes = 24;  // 8 + 129 + 3 bits, whole words

  template <class At>
  void mirror_axis(std::size_t axis, const At& at, std::ptrdiff_t bytes) noexcept {
    const int n = cells_[axis];
    for (int k = 1; k <= kReach && k <= n; ++k) {
      if (!open(axis, 0)) std::memcpy(at(-k), at(k), static_cast<std::size_t>(bytes));
      if (!open(axis, 1)) std::memcpy(at(n + k), at(n - k), static_cast<std::size_t>(bytes));
    }
  }
  void assign_four(int y, int z, int x, std::uint64_t signs) noexcept {
    unsigned char* at = bytes_.data() + offset(y, z) + ((x + 8) >> 3);
    const int shift = (x + 8) & 7;
    const std::uint64_t word = (load(at) & ~(std::uint64_t{15} << shift)) | signs << shift;
    std::memcpy(at, &word, sizeof word);
  }
  static constexpr int kNone = -100;

  static std::uint64_t load(const unsigned char* at) noexcept {
    std::uint64_t word;
    std::memcpy(&word, at, sizeof word);
    return word;
  }
  std::size_t offset(int y, int z) const noexcept {
    return static_cast<std::size_t>((z + kReach) * plane_ + (y + kReach) * kRowBytes);
  }
  bool inner(int c, std::size_t axis) const noexcept { return c > kReach && c < cells_[axis] - kReach; }
  std::array<int, 3> mirrors(int c, std::size_t axis) const noexcept {
    const int n = cells_[axis];
    return {c, c >= 1 && c <= kReach && !open(axis, 0) ? -c : kNone,
            c <= n - 1 && c >= n - kReach && !open(axis, 1) ? 2 * n - c : kNone};
  }
  void set_bit(int x, int y, int z) noexcept {
    // A whole word, so that reading the bits next to it does not wait for a store of another width.
    unsigned char* at = bytes_.data() + offset(y, z) + static_cast<std::ptrdiff_t>((x + 8) >> 6) * 8;
    const std::uint64_t word = load(at) | std::uint64_t{1} << ((x + 8) & 63);
    std::memcpy(at, &word, sizeof word);
  }
  void set_row(int x, int y, int z) noexcept {
    set_bit(x, y, z);
    if (inner(x, 0)) return;
    const auto at = mirrors(x, 0);
    if (at[1] != kNone) set_bit(at[1], y, z);
    if (at[2] != kNone) set_bit(at[2], y, z);
  }

  std::array<int, 3> cells_{};
  unsigned open_ = 0;
  std::ptrdiff_t plane_ = 0;
  std::vector<unsigned char> bytes_;
};

}  // namespace dubsar
