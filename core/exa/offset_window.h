#pragma once
// What is known around an active edge when its offset is coded: the signs of its brick and the offsets before it
// (docs/exa.md, "Offsets").

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/extract/bit_volume.h"

namespace dubsar {

inline constexpr int kOffsetInputs = 52;
using OffsetInputs = std::array<std::int16_t, kOffsetInputs>;
/// Value and "known" of the columns one and two steps before an edge along its row.
using OffsetNear = std::array<std::array<std::int16_t, 2>, 2>;

/// Signs of the points of a brick; places outside have the sign of the nearest point of the brick.
class BrickSigns {
 public:
  static constexpr int kBorder = 3;
  BrickSigns(const BitVolume& signs, const std::array<std::int64_t, 3>& low);
  /// Points along each axis, both ends included: at most 129.
  const std::array<int, 3>& points() const noexcept { return points_; }
  bool get(int x, int y, int z) const noexcept { return row(y, z)[(x + 8) >> 3] >> (x & 7) & 1; }
  /// Where the signs of x - 3 .. x + 3 stand: 7 bits from bit (x + 5) & 7 of two bytes on.
  const unsigned char* window(int x, int y, int z) const noexcept { return row(y, z) + ((x + 5) >> 3); }
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
  const unsigned char* row(int y, int z) const noexcept {
    return bytes_.data() + ((z + kBorder) * (points_[1] + 2 * kBorder) + y + kBorder) * kRowBytes;
  }
  std::array<int, 3> points_{};
  std::vector<unsigned char> bytes_;
};

class OffsetWindow {
 public:
  explicit OffsetWindow(const BrickSigns& signs);
  /// Slices must be begun in rising order.
  void begin_slice(int z);
  /// Notes the offset of an edge: its middle in 1 / 64 of a grid step, 0..63.
  void store(int axis, int x, int y, int z, int middle) noexcept {
    *place(axis, x, y, z) = static_cast<std::uint8_t>(middle);
  }
  /// The surroundings of the edge from (x, y, z) along an axis.
  void inputs(int axis, int x, int y, int z, OffsetInputs& out) const noexcept;

 private:
  static constexpr int kSide = 136, kUnknown = 255;
  template <int kAxis>
  void gather(int x, int y, int z, OffsetInputs& out) const noexcept;
  std::uint8_t* place(int axis, int x, int y, int z) noexcept { return known_.data() + index(axis, x, y, z); }
  static std::ptrdiff_t index(int axis, int x, int y, int z) noexcept {
    return (((z & 7) * 3 + axis) * kSide + y + 3) * kSide + x + 3;
  }
  const BrickSigns& signs_;
  std::vector<std::uint8_t> known_;              ///< eight slices
  std::array<const std::uint8_t*, 5> slices_{};  ///< place of (axis 0, 0, 0) in the slices z - 2 .. z + 2
};

}  // namespace dubsar
