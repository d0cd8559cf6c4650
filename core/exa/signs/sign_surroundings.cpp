#include "core/exa/signs/sign_surroundings.h"

#include <algorithm>

#include "core/exa/coding/shared_words.h"
#include "core/exa/signs/bit_spread.h"

namespace dubsar {
namespace {
/// Every 2^shift-th bit.
std::uint64_t every(std::uint64_t bits, int shift) {
  for (; shift > 0; --shift) bits = even_bits(bits);
  return bits;
}
}  // namespace

SignSurroundings::SignSurroundings(const BitVolume& points, int level, const Dims& dims,
                                   const std::array<std::int64_t, 3>& low, const std::array<int, 3>& cells,
                                   const std::array<std::int64_t, 3>& padded)
    : points_(points), level_(level), dims_(dims), low_(low), cells_(cells) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (low[a] > 0) open_ |= 1u << (2 * a);
    if (low[a] + cells[a] < padded[a]) open_ |= 2u << (2 * a);
  }
}

/// 64 points from `at` on; 0 beyond the row.
std::uint64_t SignSurroundings::bits(const std::uint64_t* row, std::int64_t at) const noexcept {
  const std::int64_t word = at >> 6, words = points_.words_per_row();
  const int shift = static_cast<int>(at & 63);
  const std::uint64_t first = word >= 0 && word < words ? load_shared(row + word) : 0;
  if (shift == 0) return first;
  const std::uint64_t second = word + 1 >= 0 && word + 1 < words ? load_shared(row + word + 1) : 0;
  return first >> shift | second << (64 - shift);
}

/// nullptr outside of the volume.
const std::uint64_t* SignSurroundings::row(int y, int z, int level) const noexcept {
  const std::int64_t py = low_[1] + std::int64_t{y} * (1 << level), pz = low_[2] + std::int64_t{z} * (1 << level);
  if (py < 0 || pz < 0 || py >= dims_.y || pz >= dims_.z) return nullptr;
  return points_.row(py >> level_, pz >> level_);
}

/// Points 0..cells of a row.
std::array<std::uint64_t, 3> SignSurroundings::signs(const std::uint64_t* row, int level) const noexcept {
  const int shift = level - level_, count = (cells_[0] >> level) + 1;
  const std::int64_t at = low_[0] >> level_;
  std::array<std::uint64_t, 3> signs{};
  for (int done = 0; done < count; done += 64 >> shift) {
    std::uint64_t piece = every(bits(row, at + (std::int64_t{done} << shift)), shift);
    if (count - done < 64 >> shift) piece &= (std::uint64_t{1} << (count - done)) - 1;
    signs[static_cast<std::size_t>(done >> 6)] |= piece << (done & 63);
  }
  return signs;
}

void SignSurroundings::fill_row(SignLattice& lattice, int y, int z, int level) const {
  if (const std::uint64_t* from = row(y, z, level)) lattice.assign_row(y, z, signs(from, level));
}

void SignSurroundings::fill(SignLattice& lattice, int level) const {
  const auto& n = lattice.cells();
  const int shift = level - level_, last = last_x(level);
  const std::int64_t at = low_[0] >> level_;
  for (int z = 0; z <= n[2]; ++z)
    for (int y = 0; y <= n[1]; ++y) {
      const std::uint64_t* from = row(y, z, level);
      if (from == nullptr) continue;
      const bool side = (y == 0 && lattice.open(1, 0)) || (y == n[1] && lattice.open(1, 1)) ||
                        (z == 0 && lattice.open(2, 0)) || (z == n[2] && lattice.open(2, 1));
      const std::uint64_t low = every(bits(from, at - (std::int64_t{3} << shift)), shift) & 15,
                          high = every(bits(from, at + (std::int64_t{n[0]} << shift)), shift) & 15;
      if (side || n[0] <= SignLattice::kReach) {  // in a short row the sides, too, are seen in the mirror
        std::array<std::uint64_t, 3> known = side ? signs(from, level) : std::array<std::uint64_t, 3>{};
        for (int x = side ? last + 1 : 0; x <= n[0]; ++x) {  // behind the end of the volume nothing is known
          const bool own = x == 0 && lattice.open(0, 0)      ? low >> 3 & 1
                           : x == n[0] && lattice.open(0, 1) ? high & 1
                                                             : lattice.get(x, y, z);
          if (own) known[static_cast<std::size_t>(x >> 6)] |= std::uint64_t{1} << (x & 63);
        }
        lattice.assign_row(y, z, known);
      }
      if (lattice.open(0, 0)) lattice.assign_low(y, z, low);
      if (lattice.open(0, 1)) lattice.assign_high(y, z, high);
    }
  for (std::size_t a = 1; a < 3; ++a)
    for (int k = 1; k <= SignLattice::kReach; ++k)
      for (int i = 0; i <= n[3 - a]; ++i)
        for (const int behind : {-k, n[a] + k})
          if (lattice.open(a, behind < 0 ? 0 : 1)) fill_row(lattice, a == 1 ? behind : i, a == 1 ? i : behind, level);
}

}  // namespace dubsar
