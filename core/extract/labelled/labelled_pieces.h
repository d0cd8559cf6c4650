#pragma once
// How the surfaces of three labels run over the faces of one cell, and how they are cut into pieces of which each is a
// dual vertex: the rule from which the table of labelled cells is made.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/extract/labelled/labelled_cell_table.h"

namespace dubsar {

/// What joins crossings on a face: a segment between two of the same labels, or a point where three labels meet.
struct FaceElement {
  std::uint8_t face = 0;
  std::uint8_t count = 0;  ///< 2, or 3 at a triple point
  std::array<std::uint8_t, 3> edges{};
};

/// Edges of the cell, in the order in which they go round a face.
std::array<unsigned, 4> face_edges(unsigned face);

/// Faces with the labels a b a b.
std::uint8_t faces_in_turn(const CornerLabels& labels);

/// At most two a face. `resolution`: LabelledCellTable.
std::vector<FaceElement> face_elements(const CornerLabels& labels, unsigned resolution);

using LabelledChords = std::vector<LabelledChord>;  // sorted

/// Pieces of the elements of a cell: one number each, counted by their first element.
struct ElementPieces {
  std::vector<std::uint8_t> piece;
  int count = 0;
  int squares = 0;  ///< sum of the squares of the numbers of crossings
};

/// The pieces that the chords make, if they are as docs/manifold.md wants them: each chord cuts one piece in two, no
/// two lie between the same pieces, the two segments of a face lie in different pieces, and in every piece every label
/// has one closed curve, of three crossings or more.
std::optional<ElementPieces> cut_pieces(const CornerLabels& labels, const std::vector<FaceElement>& elements,
                                        const LabelledChords& chords);

/// All smallest sets of chords that do; of them those with the least sum of squares. One without chords, where none are
/// needed.
std::vector<LabelledChords> best_chords(const CornerLabels& labels, const std::vector<FaceElement>& elements);

/// The configuration that pieces of elements make.
LabelledConfig make_labelled_config(const CornerLabels& labels, const std::vector<FaceElement>& elements,
                                    const ElementPieces& pieces, const LabelledChords& chords);

}  // namespace dubsar
