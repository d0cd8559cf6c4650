#pragma once
// The cell configurations of three labels, two of which may be clay and one air (docs/manifold.md, "Labels"): the table
// of cell_table.h, extended. Generated at first use from the rule, not typed in. Numbering of corners, edges and faces:
// cell_table.h.
//
// A configuration is the labels of eight corners and one bit for each face that two labels share in turn (a b a b), in
// rising order of the faces (1: the corners of the higher label are joined). On a face a b a c those of a are always
// joined; nothing is chosen there.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/extract/cell_table.h"

namespace dubsar {

/// Of a grid point. kOther is reserved: no cell of the table has it.
enum class PointLabel : std::uint8_t { kAir, kTablet, kEnvelope, kOther };

using CornerLabels = std::array<std::uint8_t, 8>;  ///< 0, 1 or 2

/// Cuts a piece in two: between two crossings of the same two labels, or, along a triple line in the cell, between
/// three crossings of the three pairs of labels. Edges rise; a pair ends with kNone.
struct LabelledChord {
  static constexpr std::uint8_t kNone = 255;
  std::array<std::uint8_t, 3> edges{kNone, kNone, kNone};
  bool is_y() const noexcept { return edges[2] != kNone; }
  friend auto operator<=>(const LabelledChord&,
                          const LabelledChord&) = default;  // NOLINT(modernize-use-nullptr): of clang-tidy 14
};

/// As CellConfig; "inside" is the higher of the two labels at an edge, "air" the lower one.
struct LabelledConfig {
  std::uint16_t active_edges = 0;              ///< mask of the edges whose ends differ
  std::uint8_t vertices = 0;                   ///< pieces = dual vertices, 0..4
  std::uint8_t triple = 0;                     ///< mask of the pieces at which three labels meet
  std::array<std::uint16_t, 4> piece_edges{};  ///< edges whose crossing belongs to the piece, chord ends included
  std::array<CellCorner, 12> corners{};        ///< of active edges
};

class LabelledCellTable {
 public:
  static constexpr int kLabellings = 6561;  ///< 3^8
  static constexpr int kConfigs = 10581;    ///< three of them without active edges

  /// Built on first use (some 20 ms); thread-safe. 700 kB.
  static const LabelledCellTable& instance();

  /// Labels of the corners in base 3, corner 0 the lowest digit.
  static int labelling(const CornerLabels& labels) noexcept;
  static CornerLabels labels_of(int labelling) noexcept;

  /// Mask of the faces a b a b of a labelling: those that need a bit.
  std::uint8_t ambiguous_faces(int labelling) const noexcept { return ambiguous_[static_cast<std::size_t>(labelling)]; }
  /// `resolution`: one bit per ambiguous face, the lowest face first.
  int id(int labelling, unsigned resolution) const noexcept {
    return base_[static_cast<std::size_t>(labelling)] + static_cast<int>(resolution);
  }
  const LabelledConfig& config(int id) const noexcept { return configs_[static_cast<std::size_t>(id)]; }

  /// For tests and documentation.
  int labelling_of(int id) const noexcept { return labelling_[static_cast<std::size_t>(id)]; }
  unsigned resolution(int id) const noexcept {
    return static_cast<unsigned>(id - base_[static_cast<std::size_t>(labelling_of(id))]);
  }
  std::span<const LabelledChord> chords(int id) const noexcept { return chords_[static_cast<std::size_t>(id)]; }

 private:
  LabelledCellTable();
  void choose_chords();

  std::vector<std::uint8_t> ambiguous_;
  std::vector<std::uint16_t> base_, labelling_;
  std::vector<LabelledConfig> configs_;
  std::vector<std::vector<LabelledChord>> chords_;
};

/// One of the 48 symmetries of a cell together with one of the six permutations of its labels.
struct LabelledSymmetry {
  CellSymmetry cell;                    ///< never inverted
  std::array<std::uint8_t, 3> label{};  ///< image of each label
};

const std::vector<LabelledSymmetry>& labelled_symmetries();

/// Image of a configuration under a symmetry.
int transform_config(const LabelledCellTable& table, int id, const LabelledSymmetry& symmetry);

}  // namespace dubsar
