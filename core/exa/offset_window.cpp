#include "core/exa/offset_window.h"

#include <algorithm>

namespace dubsar {
namespace {
struct Step {
  int x = 0, y = 0, z = 0;
};
constexpr Step operator+(const Step& a, const Step& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Step operator*(int k, const Step& a) { return {k * a.x, k * a.y, k * a.z}; }
constexpr std::array<Step, 3> kUnit{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Neighbouring columns across the edge, in steps along the two other axes.
constexpr std::array<std::array<int, 2>, 12> kColumns{
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {-2, 0}, {2, 0}, {0, -2}, {0, 2}}};
constexpr std::array<std::array<int, 2>, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

/// Where a column crosses the surface in the same direction, by which of its points -1, 0, 1, 2 (bits 0..3) have the
/// sign of the edge's lower end: the cell 0, else -1, else 1; else far above, far below, or (the other way round) here.
struct Crossing {
  int cell = 0;
  int value = 0;  ///< without a crossing
  bool found = false;
};
constexpr std::array<Crossing, 16> kCrossings = [] {
  std::array<Crossing, 16> table{};
  for (unsigned p = 0; p < 16; ++p) {
    const auto crosses = [p](unsigned low) { return (p >> low & 3) == 1; };
    if (crosses(1))
      table[p] = {0, 0, true};
    else if (crosses(0))
      table[p] = {-1, 0, true};
    else if (crosses(2))
      table[p] = {1, 0, true};
    else
      table[p] = {0, (p >> 1 & 3) == 3 ? 112 : (p >> 1 & 3) == 0 ? -112 : 0, false};
  }
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
  if (z < 5) return;  // z + 3 was not used yet
  const auto first = known_.begin() + static_cast<std::ptrdiff_t>(index(0, -3, -3, z + 3));
  std::fill(first, first + 3 * kSide * kSide, static_cast<std::uint8_t>(kUnknown));
}

void OffsetWindow::inputs(int axis, int x, int y, int z, OffsetInputs& out) const noexcept {
  std::array<unsigned, 25> rows;
  for (int dz = -2; dz <= 2; ++dz)
    for (int dy = -2; dy <= 2; ++dy)
      rows[static_cast<std::size_t>((dz + 2) * 5 + dy + 2)] = signs_.window(x, y + dy, z + dz);
  const auto sign = [&](const Step& s) {
    return rows[static_cast<std::size_t>((s.z + 2) * 5 + s.y + 2)] >> (s.x + 3) & 1;
  };
  const auto known = [&](int along, const Step& s) { return int{known_[index(along, x + s.x, y + s.y, z + s.z)]}; };
  const unsigned own = sign({0, 0, 0});
  const int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
  const Step a = kUnit[static_cast<std::size_t>(axis)], u = kUnit[static_cast<std::size_t>(u_axis)],
             v = kUnit[static_cast<std::size_t>(v_axis)];
  std::size_t i = 0;
  for (const auto& column : kColumns) {
    const Step c = column[0] * u + column[1] * v;
    unsigned pattern = 0;
    for (int k = -1; k <= 2; ++k) pattern |= (sign(c + k * a) == own ? 1u : 0u) << (k + 1);
    const Crossing& crossing = kCrossings[pattern];
    int value = crossing.value, seen = 0;
    if (crossing.found) {
      const int middle = known(axis, c + crossing.cell * a);
      seen = middle == kUnknown ? 0 : 64;
      value = crossing.cell * 64 + (seen != 0 ? middle - 32 : 0);
    }
    out[i] = static_cast<std::int16_t>(seen != 0 ? value : 0);
    out[i + 1] = static_cast<std::int16_t>(seen != 0 ? 0 : value);
    out[i + 2] = static_cast<std::int16_t>(seen);
    i += 3;
  }
  for (int end = 0; end < 2; ++end)
    for (const auto& side : kSides) {
      const Step from = end * a, step = side[0] * u + side[1] * v;
      int near = 0, active = 0;
      if (sign(from) != sign(from + step)) {
        const bool back = side[0] + side[1] < 0;
        const int middle = known(side[0] != 0 ? u_axis : v_axis, back ? from + step : from);
        if (middle == kUnknown)
          active = 64;
        else
          near = back ? middle + 1 : 64 - middle;
      }
      out[i] = static_cast<std::int16_t>(near);
      out[i + 1] = static_cast<std::int16_t>(active);
      i += 2;
    }
  for (; i < out.size(); ++i) out[i] = 0;
}

}  // namespace dubsar
