#pragma once
// The inputs of the networks of offsets in the order in which they are gathered: what a column or side needs for vector
// units stands together, and inputs that are 0 whatever comes are left out (docs/exa.md, "Inputs").

#include <array>
#include <cstddef>
#include <cstdint>

namespace dubsar {

inline constexpr int kOffsetInputs = 52;  ///< of the documented network

/// A column beside an edge of axis a: steps along axes u = a + 1 and v = a + 2.
struct OffsetColumn {
  int u = 0, v = 0;
};
/// An edge that ends or starts at an edge: at its end 0 or 1; away along -u, +u, -v, +v.
struct OffsetSide {
  std::size_t end = 0, way = 0;
};

struct OffsetLayout {
  std::array<OffsetColumn, 12> columns;  ///< those that may be coded before the edge come first
  std::size_t known = 0;                 ///< how many
  std::array<OffsetSide, 8> sides;       ///< the first four may be coded before
  /// 8 sides not known, 4 known; columns known: values, flags; 12 columns not known: values.
  constexpr std::size_t inputs() const noexcept { return 24 + 2 * known; }
};

/// By axis. Edges are coded in rising z, y, axis, x: which of them are known follows.
inline constexpr std::array<OffsetLayout, 3> kOffsetLayouts{
    {{{{{-1, -1}, {0, -1}, {1, -1}, {0, -2}, {-1, 0}, {-2, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 2}, {-1, 1}, {1, 1}}},
      6,
      {{{0, 0}, {1, 0}, {0, 2}, {1, 2}, {0, 1}, {0, 3}, {1, 1}, {1, 3}}}},
     {{{{-1, -1}, {-1, 0}, {-1, 1}, {-2, 0}, {0, -1}, {0, 1}, {0, -2}, {0, 2}, {1, -1}, {1, 0}, {1, 1}, {2, 0}}},
      8,
      {{{0, 0}, {1, 0}, {0, 2}, {0, 3}, {0, 1}, {1, 1}, {1, 2}, {1, 3}}}},
     {{{{-1, -1}, {0, -1}, {1, -1}, {0, -2}, {-1, 0}, {-2, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 2}, {-1, 1}, {1, 1}}},
      12,
      {{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 0}, {1, 1}, {1, 2}, {1, 3}}}}}};
inline constexpr std::size_t kMostOffsetInputs = 48;

/// Columns in the order of the documented inputs.
inline constexpr std::array<OffsetColumn, 12> kDocumentedColumns{
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {-2, 0}, {2, 0}, {0, -2}, {0, 2}}};
constexpr std::size_t documented_column(const OffsetColumn& column) noexcept {
  std::size_t c = 0;
  while (kDocumentedColumns[c].u != column.u || kDocumentedColumns[c].v != column.v) ++c;
  return c;
}
/// The documented input that stands at `place` of a layout.
constexpr std::size_t documented_input(const OffsetLayout& layout, std::size_t place) noexcept {
  if (place < 12) {
    const OffsetSide& side = layout.sides[place % 8];
    return 36 + side.end * 8 + 2 * side.way + (place < 8 ? 1 : 0);
  }
  place -= 12;
  if (place < layout.known) return 3 * documented_column(layout.columns[place]);
  if (place < 2 * layout.known) return 3 * documented_column(layout.columns[place - layout.known]) + 2;
  return 3 * documented_column(layout.columns[place - 2 * layout.known]) + 1;
}

}  // namespace dubsar
