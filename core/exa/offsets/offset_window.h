#pragma once
// What is known around the active edges of a brick when their offsets are coded: the signs of the brick and the offsets
// before (docs/exa.md, "Offsets").

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/extract/bit_volume.h"

namespace dubsar {

/// Signs of the points of a brick; places outside have the sign of the nearest point of the brick.
class BrickSigns {
 public:
  static constexpr int kBorder = 3;
  BrickSigns(const BitVolume& signs, const std::array<std::int64_t, 3>& low);
  /// Points along each axis, both ends included: at most 129.
  const std::array<int, 3>& points() const noexcept { return points_; }
  bool get(int x, int y, int z) const noexcept { return row(y, z)[(x + 8) >> 3] >> (x & 7) & 1; }
  /// Signs of a row: bit x + 8, lowest bit of a byte first.
  const unsigned char* row(int y, int z) const noexcept {
    return bytes_.data() + ((z + kBorder) * (points_[1] + 2 * kBorder) + y + kBorder) * kRowBytes;
  }
  /// Bytes from a row to the one of the next y, and of the next z.
  static constexpr std::ptrdiff_t kRowBytes = 32;
  std::ptrdiff_t plane_bytes() const noexcept { return (points_[1] + 2 * kBorder) * kRowBytes; }
  /// Signs from x = 0, 64 or 128 on.
  std::uint64_t word(int y, int z, int from) const noexcept {
    std::uint64_t bits;
    std::memcpy(&bits, row(y, z) + 1 + from / 8, sizeof bits);
    return bits;
  }

 private:
  std::array<int, 3> points_{};
  std::vector<unsigned char> bytes_;
};

/// Where a row of edges stands, for the kernels.
struct OffsetPlace {
  static constexpr std::ptrdiff_t kKnownRow = 136;  ///< from a row of known offsets to that of the next y
  const unsigned char* signs = nullptr;             ///< as BrickSigns::row()
  std::ptrdiff_t sign_plane = 0;
  /// [axis][z - 2 .. z]: x = 0 of the row; 0 or 1 + the middle of the offset in 1 / 64 of a grid step.
  std::array<std::array<const std::uint8_t*, 3>, 3> known{};
};

/// The offsets of the slice that is coded and of the two before.
class OffsetWindow {
 public:
  explicit OffsetWindow(const BrickSigns& signs);
  /// Slices must be begun in rising order.
  void begin_slice(int z);
  OffsetPlace place(int y, int z) const noexcept;
  /// Where the middles (0..63) of the offsets of a row are to be noted, each as 1 + middle, by x.
  std::uint8_t* open_row(int axis, int y, int z) noexcept {
    written_[slot(axis, z)][static_cast<std::size_t>(y)] = 1;
    return known_.data() + index(axis, y, z);
  }

 private:
  static constexpr int kRows = 136;
  static std::size_t slot(int axis, int z) noexcept {
    return static_cast<std::size_t>(z & 3) * 3 + static_cast<std::size_t>(axis);
  }
  /// Of x = 0.
  static std::ptrdiff_t index(int axis, int y, int z) noexcept {
    return ((std::ptrdiff_t{z & 3} * 3 + axis) * kRows + y + 3) * OffsetPlace::kKnownRow + 3;
  }
  const BrickSigns& signs_;
  std::vector<std::uint8_t> known_;                          ///< four slices
  std::array<std::array<std::uint8_t, 130>, 12> written_{};  ///< rows that are not all 0
};

}  // namespace dubsar
