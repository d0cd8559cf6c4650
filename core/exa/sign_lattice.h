#pragma once
// Signs of a brick on one lattice, with a border in which the brick is mirrored, so that the surroundings of a point
// are read without looking where the brick ends.

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace dubsar {

class SignLattice {
 public:
  static constexpr int kReach = 3;  ///< the border is as wide as the window of the model

  SignLattice() = default;
  /// `cells` along each axis, at most 128; points 0..cells. All signs are 0.
  explicit SignLattice(const std::array<int, 3>& cells)
      : cells_(cells),
        plane_((cells[1] + 1 + 2 * kReach) * kRowBytes),
        bytes_(static_cast<std::size_t>((cells[2] + 1 + 2 * kReach) * plane_ + 2 * kRowBytes)) {}

  const std::array<int, 3>& cells() const noexcept { return cells_; }
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
  /// The row of points (y, z): bit x + 8, lowest bit of a byte first.
  const unsigned char* row(int y, int z) const noexcept { return bytes_.data() + offset(y, z); }
  /// 64 signs of a row from x = 0, 64 or 128 on; what lies beyond the border is 0 or the mirror.
  std::uint64_t word(int y, int z, int from = 0) const noexcept { return load(row(y, z) + 1 + from / 8); }
  /// Signs 1..64 of a row.
  std::uint64_t next_word(int y, int z) const noexcept { return word(y, z) >> 1 | std::uint64_t{row(y, z)[9]} << 63; }
  /// From a row to the one (dy, dz) further.
  std::ptrdiff_t step(int dy, int dz) const noexcept { return dz * plane_ + dy * kRowBytes; }

 private:
  static constexpr std::ptrdiff_t kRowBytes = 24;  // 8 + 129 + 3 bits, whole words
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
    return {c, c >= 1 && c <= kReach ? -c : kNone, c <= n - 1 && c >= n - kReach ? 2 * n - c : kNone};
  }
  void set_bit(int x, int y, int z) noexcept {
    bytes_[offset(y, z) + static_cast<std::size_t>((x + 8) >> 3)] |= static_cast<unsigned char>(1 << (x & 7));
  }
  void set_row(int x, int y, int z) noexcept {
    set_bit(x, y, z);
    if (inner(x, 0)) return;
    const auto at = mirrors(x, 0);
    if (at[1] != kNone) set_bit(at[1], y, z);
    if (at[2] != kNone) set_bit(at[2], y, z);
  }

  std::array<int, 3> cells_{};
  std::ptrdiff_t plane_ = 0;
  std::vector<unsigned char> bytes_;
};

}  // namespace dubsar
