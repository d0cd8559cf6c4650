#pragma once
// Tables for offset_kernels.cpp: sixteen bytes for the columns or the sides of an edge.

#include <array>
#include <cstdint>

#include "core/exa/offsets/offset_layout.h"

namespace dubsar::offset_tables {
struct alignas(16) Lanes : std::array<std::uint8_t, 16> {};
constexpr std::uint8_t kNone = 0x80;  ///< a lane of no byte
constexpr std::uint8_t byte(int value) { return static_cast<std::uint8_t>(value); }

/// Where a column crosses the surface in the same direction, by which of its points -1, 0, 1, 2 (bits 0..3) have the
/// sign of the edge's lower end: the cell 0, else -1, else 1; else far above, far below, or (the other way round) here.
struct Crossings {
  Lanes cell{};                  ///< 1 + the cell, or kNone
  std::array<Lanes, 3> among{};  ///< all bits where the cell is -1, 0, 1
  Lanes add{};                   ///< from 1 + the middle of an offset to the value
  Lanes missing{};               ///< value without an offset
};
constexpr Crossings kCrossings = [] {
  Crossings table{};
  for (unsigned p = 0; p < 16; ++p) {
    const auto crosses = [p](unsigned low) { return (p >> low & 3) == 1; };
    const int cell = crosses(1) ? 0 : crosses(0) ? -1 : crosses(2) ? 1 : 2;
    table.cell[p] = cell == 2 ? kNone : byte(1 + cell);
    for (int c = -1; c <= 1; ++c) table.among[static_cast<std::size_t>(c + 1)][p] = cell == c ? 255 : 0;
    table.add[p] = byte(cell == 2 ? 0 : 64 * cell - 33);
    table.missing[p] = byte(cell != 2 ? 64 * cell : (p >> 1 & 3) == 3 ? 112 : (p >> 1 & 3) == 0 ? -112 : 0);
  }
  return table;
}();

/// By lane, for the layout of an axis.
struct Layout {
  std::array<Lanes, 5> pick{};  ///< columns from rows two before .. two behind: steps along x + 2
  Lanes side_column{}, side_flip{}, side_bit{}, side_turn{}, side_add{};
};
constexpr std::array<Layout, 3> kLayouts = [] {
  std::array<Layout, 3> layouts{};
  constexpr std::array<OffsetColumn, 4> kWays{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const OffsetLayout& from = kOffsetLayouts[axis];
    Layout& to = layouts[axis];
    for (Lanes& lanes : to.pick)
      for (std::uint8_t& lane : lanes) lane = kNone;
    for (std::uint8_t& lane : to.side_column) lane = kNone;
    for (std::size_t c = 0; c < 12; ++c) {
      const int along_x = axis == 1 ? from.columns[c].v : from.columns[c].u;
      const int row = axis == 1 ? from.columns[c].u : from.columns[c].v;
      if (axis != 0) to.pick[static_cast<std::size_t>(row + 2)][c] = byte(along_x + 2);
    }
    for (std::size_t s = 0; s < 8; ++s) {
      const OffsetSide& side = from.sides[s];
      for (std::size_t c = 0; c < 12; ++c)
        if (from.columns[c].u == kWays[side.way].u && from.columns[c].v == kWays[side.way].v)
          to.side_column[s] = byte(int(c));
      to.side_bit[s] =
          side.end == 0 ? 2 : 4;  // an edge from the start goes to another sign, one from the end to the own
      to.side_flip[s] = side.end == 0 ? 2 : 0;
      if (side.way % 2 == 1) to.side_turn[s] = 255, to.side_add[s] = 66;  // 65 - t
    }
  }
  return layouts;
}();
/// Of the columns of axis 0: where the bytes of the first four, and of the next two, begin.
constexpr Lanes kFirstFour{
    {0, 4, 8, 12, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    kNextTwo{{kNone, kNone, kNone, kNone, 0, 4, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone}};
}  // namespace dubsar::offset_tables
