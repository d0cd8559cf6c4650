#include "core/exa/offset_window.h"

#include <algorithm>

namespace dubsar {
namespace {
/// Neighbouring columns across the edge, in steps along the two other axes.
constexpr std::array<std::array<int, 2>, 12> kColumns{
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {-2, 0}, {2, 0}, {0, -2}, {0, 2}}};
constexpr std::array<std::array<int, 2>, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

/// Where a column crosses the surface in the same direction, by which of its points -1, 0, 1, 2 (bits 0..3) have the
/// sign of the edge's lower end: the cell 0, else -1, else 1; else far above, far below, or (the other way round) here.
struct Crossing {
  std::int16_t cell = 0;
  std::int16_t value = 0;  ///< of the cell, or without a crossing
  std::int16_t found = 0;  ///< -1 or 0
};
constexpr std::array<Crossing, 16> kCrossings = [] {
  std::array<Crossing, 16> table{};
  for (unsigned p = 0; p < 16; ++p) {
    const auto crosses = [p](unsigned low) { return (p >> low & 3) == 1; };
    if (crosses(1))
      table[p] = {0, 0, -1};
    else if (crosses(0))
      table[p] = {-1, -64, -1};
    else if (crosses(2))
      table[p] = {1, 64, -1};
    else
      table[p] = {0, static_cast<std::int16_t>((p >> 1 & 3) == 3 ? 112 : (p >> 1 & 3) == 0 ? -112 : 0), 0};
  }
  return table;
}();

/// The bits of a window of seven signs, each in a byte of its own.
constexpr std::array<std::uint64_t, 128> kBytes = [] {
  std::array<std::uint64_t, 128> table{};
  for (std::uint64_t w = 0; w < 128; ++w)
    for (int bit = 0; bit < 7; ++bit) table[w] |= (w >> bit & 1) << (8 * bit);
  return table;
}();
}  // namespace

BrickSigns::BrickSigns(const BitVolume& signs, const std::array<std::int64_t, 3>& low) {
  const Dims& d = signs.dims();
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z};
  for (std::size_t a = 0; a < 3; ++a) points_[a] = static_cast<int>(std::min<std::int64_t>(129, size[a] - low[a]));
  bytes_.assign(static_cast<std::size_t>((points_[2] + 2 * kBorder) * (points_[1] + 2 * kBorder) * kRowBytes), 0);
  std::size_t at = 0;
  for (int z = -kBorder; z < points_[2] + kBorder; ++z)
    for (int y = -kBorder; y < points_[1] + kBorder; ++y, at += kRowBytes) {
      const std::uint64_t* from =
          signs.row(low[1] + std::clamp(y, 0, points_[1] - 1), low[2] + std::clamp(z, 0, points_[2] - 1)) + low[0] / 64;
      unsigned char* to = bytes_.data() + at;
      std::memcpy(to + 1, from, static_cast<std::size_t>((points_[0] + 63) / 64) * 8);
      const int end = points_[0] + 8;
      const bool first = to[1] & 1, last = to[(end - 1) >> 3] >> ((end - 1) & 7) & 1;
      to[0] = first ? 255 : 0;
      for (int bit = end; bit < end + 8; ++bit) {
        const auto mask = static_cast<unsigned char>(1u << (bit & 7));
        to[bit >> 3] = static_cast<unsigned char>(last ? to[bit >> 3] | mask : to[bit >> 3] & ~mask);
      }
    }
}

OffsetWindow::OffsetWindow(const BrickSigns& signs)
    : signs_(signs), known_(static_cast<std::size_t>(8 * 3 * kSide * kSide), kUnknown) {}

void OffsetWindow::begin_slice(int z) {
  for (int dz = -2; dz <= 2; ++dz) slices_[static_cast<std::size_t>(dz + 2)] = known_.data() + index(0, 0, 0, z + dz);
  if (z < 5) return;  // z + 3 was not used yet
  const auto first = known_.begin() + index(0, -3, -3, z + 3);
  std::fill(first, first + 3 * kSide * kSide, static_cast<std::uint8_t>(kUnknown));
}

template <int kAxis>
void OffsetWindow::gather(int x, int y, int z, OffsetInputs& out) const noexcept {
  constexpr int kU = (kAxis + 1) % 3, kV = (kAxis + 2) % 3;
  const unsigned char* here = signs_.window(x, y, z);
  const std::ptrdiff_t plane = signs_.plane_bytes();
  const int shift = (x + 5) & 7;
  const auto window = [&](int dy, int dz) -> unsigned {
    std::uint16_t bits;
    std::memcpy(&bits, here + dz * plane + dy * BrickSigns::kRowBytes, sizeof bits);
    return bits >> shift & 127u;
  };
  const auto known = [&](int axis, int dx, int dy, int dz) -> int {
    return slices_[static_cast<std::size_t>(dz + 2)][(axis * kSide + y + dy) * kSide + x + dx];
  };
  // Along the edge at each column: which of the points -1, 0, 1, 2 have the sign of the edge's lower end.
  const unsigned own = window(0, 0) >> 3 & 1, turned = own ? 0 : 15;
  std::array<unsigned, 12> patterns;
  if constexpr (kAxis == 0) {
    for (std::size_t c = 0; c < 12; ++c) patterns[c] = (window(kColumns[c][0], kColumns[c][1]) >> 2 & 15) ^ turned;
  } else {
    std::array<std::uint64_t, 5> side;  // by the other coordinate that is not x; one column a byte, from x - 3 on
    for (int d = -2; d <= 2; ++d) {
      std::uint64_t all = 0;
      for (int k = -1; k <= 2; ++k) all |= kBytes[kAxis == 1 ? window(k, d) : window(d, k)] << (k + 1);
      side[static_cast<std::size_t>(d + 2)] = all;
    }
    for (std::size_t c = 0; c < 12; ++c) {
      const int dx = kColumns[c][kAxis == 1 ? 1 : 0], other = kColumns[c][kAxis == 1 ? 0 : 1];
      patterns[c] = (side[static_cast<std::size_t>(other + 2)] >> (8 * (dx + 3)) & 15) ^ turned;
    }
  }
  // Two inputs a store: the network reads them in pairs, at once.
  const auto put = [&out](std::size_t i, int first, int second) {
    const std::uint32_t pair = static_cast<std::uint16_t>(first) | static_cast<std::uint32_t>(second) << 16;
    std::memcpy(out.data() + i, &pair, sizeof pair);
  };
  struct Column {
    int known, sign, seen;
  };
  const auto column = [&](std::size_t c) -> Column {
    const Crossing& crossing = kCrossings[patterns[c]];
    std::array<int, 3> at{0, 0, 0};
    at[kU] = kColumns[c][0];
    at[kV] = kColumns[c][1];
    at[kAxis] = crossing.cell;
    const int middle = known(kAxis, at[0], at[1], at[2]);
    const int seen = crossing.found & (middle == kUnknown ? 0 : -1);
    return {(crossing.value + middle - 32) & seen, crossing.value & ~seen, 64 & seen};
  };
#pragma GCC unroll 6
  for (std::size_t c = 0; c < 12; c += 2) {
    const Column left = column(c), right = column(c + 1);
    put(3 * c, left.known, left.sign);
    put(3 * c + 2, left.seen, right.known);
    put(3 * c + 4, right.sign, right.seen);
  }
#pragma GCC unroll 2
  for (int end = 0; end < 2; ++end) {
#pragma GCC unroll 4
    for (std::size_t s = 0; s < 4; ++s) {
      std::array<int, 3> from{0, 0, 0}, to;
      from[kAxis] = end;
      to = from;
      to[s < 2 ? kU : kV] += s % 2 == 0 ? -1 : 1;
      const bool back = s % 2 == 0;
      const unsigned sign = window(to[1], to[2]) >> (to[0] + 3) & 1;
      const int active = sign != (own ^ static_cast<unsigned>(end)) ? -1 : 0;
      const auto& start = back ? to : from;
      const int middle = known(s < 2 ? kU : kV, start[0], start[1], start[2]);
      const int seen = active & (middle == kUnknown ? 0 : -1);
      put(36 + static_cast<std::size_t>(end) * 8 + 2 * s, (back ? middle + 1 : 64 - middle) & seen,
          64 & active & ~seen);
    }
  }
}

void OffsetWindow::inputs(int axis, int x, int y, int z, OffsetInputs& out) const noexcept {
  if (axis == 0)
    gather<0>(x, y, z, out);
  else if (axis == 1)
    gather<1>(x, y, z, out);
  else
    gather<2>(x, y, z, out);
}

}  // namespace dubsar
