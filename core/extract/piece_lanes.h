#pragma once
// The cell configurations ready for vectors: which of the eight streams of edges that run along a row of cells a dual
// vertex takes, and where its crossings lie.

#include <array>
#include <cstdint>
#include <vector>

#include "core/extract/cell_table.h"

namespace dubsar {

/// The edges around a row of cells (along x) that may be active, as streams in which each active edge has the number
/// that follows the one before: lanes 0, 3, 4, 7 along x at the four rows of points; 1, 5 along y at z low and high;
/// 2, 6 along z at y low and high. While a cell is looked at its stream stands at the edge along x, or at the one along
/// y or z at its high side; the edge at the low side, if active, is the one before. So the lanes of one half of a
/// vector have the axes x, y, z, x.
inline constexpr int kEdgeStreams = 8;
inline constexpr std::array<std::uint8_t, 12> kStreamOfEdge = {0, 3, 4, 7, 1, 5, 1, 5, 2, 2, 6, 6};
/// 1: the edge lies at the low side of the cell in its stream.
inline constexpr std::array<std::uint8_t, 12> kLowInStream = {0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0};

/// One dual vertex of at most eight edges. Lists are in the order in which the x-quads are numbered; places behind
/// `count` repeat the first.
struct alignas(64) PieceLanes {
  std::array<std::uint32_t, kEdgeStreams> crossings{};  ///< by stream: low half all ones: the edge before; high: at it
  std::array<std::uint8_t, 8> stream{};
  std::array<std::int8_t, 8> place{};       ///< corner of the x-quad, less 4 where it is the edge before
  std::array<std::uint8_t, 4> on_axis{};    ///< edges along x, y, z
  std::array<std::uint8_t, 4> high_side{};  ///< edges on the high side of the cell across x, y, z
  std::uint8_t count = 0;                   ///< 0: more than eight edges, or the second vertex of a doubled corner
};

struct ConfigLanes {
  std::array<std::uint8_t, kEdgeStreams> steps{};  ///< 1: the stream moves on behind this cell
  std::uint16_t first_piece = 0;
  std::uint8_t vertices = 0;
  std::uint8_t incidences = 0;
};

struct PieceTable {
  std::array<ConfigLanes, CellTable::kConfigs> configs;
  std::vector<PieceLanes> pieces;  ///< those of a configuration follow one another
  /// [offset bits][n]: 1 / (n grid steps in half quanta).
  std::array<std::array<double, 13>, 17> inverse{};

  /// Built on first use; thread-safe.
  static const PieceTable& instance();
};

}  // namespace dubsar
