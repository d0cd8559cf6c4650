#pragma once
// The 656 face-resolved cell configurations of 2-manifold dual marching cubes (paper section 3.3, figures 10 and 11),
// generated at start-up from the rule, not typed in.
//
// Numbering: corner c = x + 2y + 4z; edge e = 4a + ou + 2ov lies along axis a at offsets ou, ov of the axes
// u = (a + 1) % 3, v = (a + 2) % 3; face f = 2a + side is perpendicular to axis a. A configuration is a sign pattern
// (bit c: corner c inside) plus one bit per ambiguous face in rising order (1: the inside corners are joined).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace dubsar {

/// A closed curve of the surface on the boundary of a cell. faces[i] is crossed from edges[i] to edges[i + 1]. The
/// inside lies to the right of the direction of walk, seen from outside the cell.
struct CellCycle {
  std::vector<std::uint8_t> edges;
  std::vector<std::uint8_t> faces;
  std::uint8_t pinched = 0;  ///< mask of the ambiguous faces that the curve crosses twice
};

/// Splits a curve in two between the crossings of two cell edges, a < b.
struct CellChord {
  std::uint8_t a = 0, b = 0;
  friend auto operator<=>(const CellChord&,
                          const CellChord&) = default;  // NOLINT(modernize-use-nullptr): of clang-tidy 14
};

/// How the x-quad around one active edge meets this cell.
struct CellCorner {
  std::uint8_t corner = 0;  ///< corner 0..3 of the x-quad, counter-clockwise from the air; 0: the cell at +u, +v
  std::uint8_t first = 0;   ///< piece where the polygon enters the cell
  std::uint8_t second = 0;  ///< piece where it leaves; differs where the cell is split at this edge
};

/// One edge of a piece, in the order in which the x-quads of the edges are numbered.
struct PieceEdge {
  std::uint8_t edge = 0;
  std::uint8_t axis = 0;
  std::uint8_t corner = 0;  ///< of the x-quad
  bool is_second = false;   ///< here the piece is the second vertex of a doubled corner
};

/// One dual vertex: its crossings and where they lie.
struct CellPiece {
  std::uint8_t count = 0;
  std::array<std::uint8_t, 3> high{};  ///< per axis: edges across it on the high side of the cell
  std::array<PieceEdge, 12> edges{};
};

struct CellConfig {
  std::uint16_t active_edges = 0;              ///< mask of 12
  std::uint8_t vertices = 0;                   ///< pieces = dual vertices, 0..4
  std::uint8_t incidences = 0;                 ///< sum of the popcounts of piece_edges
  std::array<std::uint16_t, 4> piece_edges{};  ///< edges whose crossing belongs to the piece, chord ends included
  std::array<CellCorner, 12> corners{};        ///< of active edges
  std::array<CellPiece, 4> pieces{};           ///< the same, ready for writing
};

class CellTable {
 public:
  static constexpr int kConfigs = 656;

  /// Built on first use (about a millisecond); thread-safe.
  static const CellTable& instance();

  /// Mask of the ambiguous faces of a sign pattern.
  std::uint8_t ambiguous_faces(unsigned signs) const noexcept { return ambiguous_[signs]; }
  /// `resolution`: one bit per ambiguous face, the lowest face first.
  int id(unsigned signs, unsigned resolution) const noexcept { return base_[signs] + static_cast<int>(resolution); }
  const CellConfig& config(int id) const noexcept { return configs_[static_cast<std::size_t>(id)]; }

  /// For tests and documentation.
  unsigned signs(int id) const noexcept { return signs_[static_cast<std::size_t>(id)]; }
  unsigned resolution(int id) const noexcept { return static_cast<unsigned>(id) - base_[signs(id)]; }
  std::span<const CellCycle> cycles(int id) const noexcept { return cycles_[static_cast<std::size_t>(id)]; }
  std::span<const CellChord> chords(int id) const noexcept { return chords_[static_cast<std::size_t>(id)]; }

 private:
  CellTable();

  std::array<std::uint8_t, 256> ambiguous_{};
  std::array<std::uint16_t, 256> base_{};
  std::array<CellConfig, kConfigs> configs_;
  std::array<std::uint8_t, kConfigs> signs_{};
  std::array<std::vector<CellCycle>, kConfigs> cycles_;
  std::array<std::vector<CellChord>, kConfigs> chords_;
};

/// One of the 96 symmetries of a cell: 48 signed axis permutations, each with or without exchange of inside and
/// outside.
struct CellSymmetry {
  std::array<std::uint8_t, 8> corner;  ///< image of each corner
  std::array<std::uint8_t, 12> edge;
  std::array<std::uint8_t, 6> face;
  bool axes_fixed = false;  ///< mirrors only: no axis is exchanged with another
  bool inverted = false;
};

const std::vector<CellSymmetry>& cell_symmetries();

/// Image of a configuration under a symmetry.
int transform_config(const CellTable& table, int id, const CellSymmetry& symmetry);

/// Corners at the two ends of an edge, the lower first.
constexpr std::array<unsigned, 2> edge_corners(unsigned edge) noexcept {
  const unsigned a = edge / 4, u = (a + 1) % 3, v = (a + 2) % 3;
  const unsigned low = ((edge & 1u) << u) | (((edge >> 1) & 1u) << v);
  return {low, low | (1u << a)};
}

}  // namespace dubsar
