#pragma once
// The walk over a brick of signs from a lattice of spacing 8 to one of spacing 1 (docs/exa.md, "Signs"). Encoder and
// decoder walk the same way; a Coder says what a bit is:
//   bool flag(int context, int level, int x, int y, int z)   does this cell of equal corners hide a surface?
//   void begin(const SignLattice&, int level, int phase)           points of this phase follow
//   void row(SignLattice&, int level, int y, int z, std::span<const std::uint8_t> xs)    sets the signs of some points

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/exa/signs/bit_spread.h"
#include "core/exa/signs/sign_lattice.h"
#include "core/exa/signs/sign_surroundings.h"

namespace dubsar {

/// Points by which of their coordinates are odd (bit a: axis a), in the order in which they are coded.
inline constexpr std::array<int, 7> kSignPhases{7, 6, 5, 3, 4, 2, 1};
inline constexpr int kBrickLevels = 3;        ///< spacing 4, 2, 1
inline constexpr int kFlagContexts = 3 * 28;  ///< level 3, 2, 1; corners; mixed neighbours 0..6; hidden neighbours

class SignBrick {
 public:
  /// `top`: signs of the lattice of spacing 8, at most 16 cells along an axis. `around`: nullptr when nothing is known
  /// of other bricks; must outlive the refining.
  explicit SignBrick(SignLattice top, const SignSurroundings* around = nullptr)
      : lattice_(std::move(top)), around_(around) {}

  /// From the lattice of spacing 2^(level + 1) to that of 2^level, level = 2, 1, 0 in this order.
  template <class Coder>
  void refine(Coder& coder, int level) {
    find_active(coder, level + 1);
    refine_without_surface(level);
    for (const int phase : kSignPhases) code_phase(coder, level, phase);
  }
  const SignLattice& lattice() const noexcept { return lattice_; }

 private:
  static std::size_t rows(const SignLattice& l) {
    return static_cast<std::size_t>(l.cells()[1]) * static_cast<std::size_t>(l.cells()[2]);
  }
  static std::uint64_t low_bits(int n) { return n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1; }
  std::size_t at(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(lattice_.cells()[1]) + static_cast<std::size_t>(y);
  }

  std::vector<std::uint64_t> mixed_cells() const {
    std::vector<std::uint64_t> mixed(rows(lattice_));
    const auto& n = lattice_.cells();
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y) {
        std::uint64_t any = 0, all = ~std::uint64_t{0};
        for (int c = 0; c < 4; ++c) {
          const std::uint64_t low = lattice_.word(y + c % 2, z + c / 2),
                              high = lattice_.next_word(y + c % 2, z + c / 2);
          any |= low | high;
          all &= low & high;
        }
        mixed[at(y, z)] = any & ~all & low_bits(n[0]);
      }
    return mixed;
  }

  /// Fills active_ for the cells of the present lattice.
  template <class Coder>
  void find_active(Coder& coder, int level) {
    const auto& n = lattice_.cells();
    const std::vector<std::uint64_t> mixed = mixed_cells(), parents = std::move(active_);
    active_ = mixed;
    std::vector<std::uint64_t> hidden(mixed.size(), 0);
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y) {
        std::uint64_t candidates = low_bits(n[0]);
        if (!parents.empty()) {
          const std::uint64_t parent = parents[static_cast<std::size_t>(z / 2) * static_cast<std::size_t>(n[1] / 2) +
                                               static_cast<std::size_t>(y / 2)];
          candidates &= spread_bits(parent) | spread_bits(parent) << 1;
        }
        for (std::uint64_t rest = candidates & ~mixed[at(y, z)]; rest != 0; rest &= rest - 1) {
          const int x = std::countr_zero(rest);
          const auto bit = [&](const std::vector<std::uint64_t>& words, int bx, int by, int bz) {
            return bx >= 0 && by >= 0 && bz >= 0 && bx < n[0] && by < n[1] && bz < n[2]
                       ? static_cast<int>(words[at(by, bz)] >> bx & 1)
                       : 0;
          };
          const int near = bit(mixed, x - 1, y, z) + bit(mixed, x + 1, y, z) + bit(mixed, x, y - 1, z) +
                           bit(mixed, x, y + 1, z) + bit(mixed, x, y, z - 1) + bit(mixed, x, y, z + 1);
          const int before = bit(hidden, x - 1, y, z) | bit(hidden, x, y - 1, z) | bit(hidden, x, y, z - 1);
          const int context = (3 - level) * 28 + before * 14 + (lattice_.get(x, y, z) ? 7 : 0) + near;
          if (!coder.flag(context, level, x, y, z)) continue;
          hidden[at(y, z)] |= std::uint64_t{1} << x;
          active_[at(y, z)] |= std::uint64_t{1} << x;
        }
      }
  }

  /// 129 signs of a row.
  using RowSigns = std::array<std::uint64_t, 3>;
  /// Bit i to bit 2 i.
  static RowSigns doubled(std::uint64_t w) { return {spread_bits(w), spread_bits(w >> 32), 0}; }

  /// The next finer lattice with the signs that are known: those of this one, and those of inactive cells.
  void refine_without_surface(int level) {
    const auto& n = lattice_.cells();
    SignLattice fine({2 * n[0], 2 * n[1], 2 * n[2]}, around_ ? around_->open() : 0);
    std::vector<RowSigns> inside(rows(lattice_));  // points of inactive cells of sign 1, by rows of cells
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y) {
        const RowSigns first = doubled(lattice_.word(y, z) & ~active_[at(y, z)] & low_bits(n[0]));
        inside[at(y, z)] = {first[0] | first[0] << 1 | first[0] << 2,
                            first[1] | first[1] << 1 | first[1] << 2 | first[0] >> 62, first[1] >> 62};
      }
    for (int z = 0; z <= 2 * n[2]; ++z)
      for (int y = 0; y <= 2 * n[1]; ++y) {
        RowSigns row{};
        if (y % 2 == 0 && z % 2 == 0) {
          const bool last = lattice_.get(n[0], y / 2, z / 2);
          row = doubled(lattice_.word(y / 2, z / 2) & low_bits(n[0]));
          row[static_cast<std::size_t>(2 * n[0] / 64)] |= std::uint64_t{last} << (2 * n[0] % 64);
        }
        for (int cz = std::max(0, (z - 1) >> 1); cz <= std::min(n[2] - 1, z >> 1); ++cz)
          for (int cy = std::max(0, (y - 1) >> 1); cy <= std::min(n[1] - 1, y >> 1); ++cy)
            for (std::size_t w = 0; w < 3; ++w) row[w] |= inside[at(cy, cz)][w];
        if ((row[0] | row[1] | row[2]) != 0) fine.assign_row(y, z, row);
      }
    if (around_) around_->fill(fine, level);
    fine.mirror();
    lattice_ = std::move(fine);
  }

  /// The points of one kind all of whose coarser cells are active, in rising z, y, x.
  template <class Coder>
  void code_phase(Coder& coder, int level, int phase) {
    const auto& n = lattice_.cells();
    const int parents_x = n[0] / 2, parents_y = n[1] / 2, parents_z = n[2] / 2;
    std::array<std::uint8_t, 130> xs;
    coder.begin(lattice_, level, phase);
    for (int z = phase >> 2 & 1; z <= n[2]; z += 2)
      for (int y = phase >> 1 & 1; y <= n[1]; y += 2) {
        std::uint64_t all = ~std::uint64_t{0};
        for (int pz = (z - 1) >> 1; pz <= z >> 1; ++pz)
          for (int py = (y - 1) >> 1; py <= y >> 1; ++py)
            if (pz >= 0 && py >= 0 && pz < parents_z && py < parents_y)
              all &= active_[static_cast<std::size_t>(pz) * static_cast<std::size_t>(parents_y) +
                             static_cast<std::size_t>(py)];
        if (all == 0) continue;
        int count = 0;
        if (phase & 1) {
          for (; all != 0; all &= all - 1) xs[count++] = static_cast<std::uint8_t>(2 * std::countr_zero(all) + 1);
        } else {
          const bool last = all >> (parents_x - 1) & 1;
          for (std::uint64_t even = (all << 1 | 1) & all; even != 0; even &= even - 1)
            xs[count++] = static_cast<std::uint8_t>(2 * std::countr_zero(even));
          if (last) xs[count++] = static_cast<std::uint8_t>(n[0]);
        }
        const std::span<const std::uint8_t> open = unknown({xs.data(), static_cast<std::size_t>(count)}, y, z, level);
        if (!open.empty()) coder.row(lattice_, level, y, z, open);
      }
  }
  /// Those of rising points of a row that the bricks beside this one do not have.
  std::span<const std::uint8_t> unknown(std::span<const std::uint8_t> xs, int y, int z, int level) const {
    if (!around_ || lattice_.open_sides() == 0 || !around_->inside(y, z, level)) return xs;
    const auto& n = lattice_.cells();
    const bool side = (y == 0 && lattice_.open(1, 0)) || (y == n[1] && lattice_.open(1, 1)) ||
                      (z == 0 && lattice_.open(2, 0)) || (z == n[2] && lattice_.open(2, 1));
    const int known = side ? around_->last_x(level) : lattice_.open(0, 0) ? 0 : -1;
    while (!xs.empty() && xs.front() <= known) xs = xs.subspan(1);
    if (!xs.empty() && xs.back() == n[0] && lattice_.open(0, 1)) xs = xs.first(xs.size() - 1);
    return xs;
  }

  SignLattice lattice_;
  const SignSurroundings* around_;
  std::vector<std::uint64_t> active_;  ///< one word of cells for each row (z, y) of the lattice before the last refine
};

}  // namespace dubsar
