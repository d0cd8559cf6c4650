#include "core/extract/labelled/labelled_cell_table.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "core/base/result.h"
#include "core/extract/labelled/labelled_pieces.h"

namespace dubsar {
namespace {

unsigned labels_present(const CornerLabels& labels) {
  unsigned present = 0;
  for (const std::uint8_t label : labels) present |= 1u << label;
  return present;
}

LabelledChords image_of_chords(const LabelledChords& chords, const LabelledSymmetry& symmetry) {
  LabelledChords image;
  for (LabelledChord chord : chords) {
    for (std::uint8_t& e : chord.edges)
      if (e != LabelledChord::kNone) e = symmetry.cell.edge[e];
    std::sort(chord.edges.begin(), chord.edges.end());
    image.push_back(chord);
  }
  std::sort(image.begin(), image.end());
  return image;
}

/// Two labels: today's table, with the higher label inside.
LabelledConfig config_of_two(const CellConfig& config) {
  return {config.active_edges, config.vertices, 0, config.piece_edges, config.corners};
}

/// The first set of chords that every symmetry of the configuration in `group` maps to itself.
std::optional<LabelledChords> symmetric_chords(const LabelledCellTable& table, int id,
                                               const std::vector<LabelledChords>& sets,
                                               const std::vector<LabelledSymmetry>& group) {
  std::vector<const LabelledSymmetry*> own;
  for (const LabelledSymmetry& g : group)
    if (transform_config(table, id, g) == id) own.push_back(&g);
  for (const LabelledChords& chords : sets)
    if (std::all_of(own.begin(), own.end(), [&](const auto* g) { return image_of_chords(chords, *g) == chords; }))
      return chords;
  return std::nullopt;
}

}  // namespace

int LabelledCellTable::labelling(const CornerLabels& labels) noexcept {
  int sum = 0;
  for (std::size_t c = 8; c-- > 0;) sum = 3 * sum + labels[c];
  return sum;
}

CornerLabels LabelledCellTable::labels_of(int labelling) noexcept {
  CornerLabels labels{};
  for (std::uint8_t& label : labels) {
    label = static_cast<std::uint8_t>(labelling % 3);
    labelling /= 3;
  }
  return labels;
}

const std::vector<LabelledSymmetry>& labelled_symmetries() {
  static const std::vector<LabelledSymmetry> symmetries = [] {
    std::vector<LabelledSymmetry> all;
    for (const CellSymmetry& g : cell_symmetries()) {
      if (g.inverted) continue;
      std::array<std::uint8_t, 3> label{0, 1, 2};
      do all.push_back({g, label});
      while (std::next_permutation(label.begin(), label.end()));
    }
    return all;
  }();
  return symmetries;
}

int transform_config(const LabelledCellTable& table, int id, const LabelledSymmetry& symmetry) {
  const int from = table.labelling_of(id);
  const CornerLabels labels = LabelledCellTable::labels_of(from);
  CornerLabels to{};
  for (std::size_t c = 0; c < 8; ++c) to[symmetry.cell.corner[c]] = symmetry.label[labels[c]];
  const int labelling = LabelledCellTable::labelling(to);
  const unsigned before = table.ambiguous_faces(from), ambiguous = table.ambiguous_faces(labelling);
  unsigned joined = 0, seen = 0, image = 0, place = 0;  // joined: bit per face
  for (unsigned f = 0; f < 6; ++f) {
    if (!(before >> f & 1u)) continue;
    const unsigned a = f / 2, corner = (f & 1u) << a;
    const std::uint8_t one = labels[corner], other = labels[corner | 1u << ((a + 1) % 3)];
    const bool turns = (one < other) != (symmetry.label[one] < symmetry.label[other]);
    joined |= unsigned{(table.resolution(id) >> seen++ & 1u) != unsigned{turns}} << symmetry.cell.face[f];
  }
  for (unsigned f = 0; f < 6; ++f)
    if (ambiguous >> f & 1u) image |= (joined >> f & 1u) << place++;
  return table.id(labelling, image);
}

LabelledCellTable::LabelledCellTable() : ambiguous_(kLabellings), base_(kLabellings) {
  for (int labelling = 0; labelling < kLabellings; ++labelling) {
    const auto l = static_cast<std::size_t>(labelling);
    ambiguous_[l] = faces_in_turn(labels_of(labelling));
    base_[l] = static_cast<std::uint16_t>(labelling_.size());
    labelling_.insert(labelling_.end(), std::size_t{1} << std::popcount(ambiguous_[l]),
                      static_cast<std::uint16_t>(labelling));
  }
  DUBSAR_CHECK(labelling_.size() == kConfigs);
  configs_.resize(kConfigs);
  chords_.resize(kConfigs);
  choose_chords();
}

/// One choice for each class of configurations, carried to the others by the symmetries, as CellTable does. Where no
/// smallest set of chords has all symmetries of its configuration, the mirrors are kept if they can be.
void LabelledCellTable::choose_chords() {
  const CellTable& two = CellTable::instance();
  std::vector<LabelledSymmetry> mirrors, same;
  for (const LabelledSymmetry& g : labelled_symmetries()) {
    if (g.cell.axes_fixed) mirrors.push_back(g);
    if (g.cell.corner == std::array<std::uint8_t, 8>{0, 1, 2, 3, 4, 5, 6, 7}) same.push_back(g);
  }
  std::vector<bool> done(kConfigs);
  for (int id = 0; id < kConfigs; ++id) {
    const auto at = static_cast<std::size_t>(id);
    const CornerLabels labels = labels_of(labelling_of(id));
    const unsigned present = labels_present(labels);
    if (std::popcount(present) == 2) {
      unsigned signs = 0;
      const auto high = static_cast<std::uint8_t>(std::bit_width(present) - 1);
      for (unsigned c = 0; c < 8; ++c) signs |= unsigned{labels[c] == high} << c;
      const int known = two.id(signs, resolution(id));
      configs_[at] = config_of_two(two.config(known));
      for (const CellChord& chord : two.chords(known))
        chords_[at].push_back({{chord.a, chord.b, LabelledChord::kNone}});
    } else if (std::popcount(present) == 3 && !done[at]) {
      std::vector<LabelledChords> sets = best_chords(labels, face_elements(labels, resolution(id)));
      std::sort(sets.begin(), sets.end());
      for (const auto* group : {&labelled_symmetries(), &std::as_const(mirrors), &std::as_const(same)}) {
        const auto chosen = symmetric_chords(*this, id, sets, *group);
        if (!chosen) continue;
        for (const LabelledSymmetry& g : *group) {
          const auto image = static_cast<std::size_t>(transform_config(*this, id, g));
          done[image] = true;
          chords_[image] = image_of_chords(*chosen, g);
        }
        break;
      }
      DUBSAR_CHECK(done[at]);
    }
    if (std::popcount(present) < 3) continue;
    const std::vector<FaceElement> elements = face_elements(labels, resolution(id));
    const auto pieces = cut_pieces(labels, elements, chords_[at]);
    DUBSAR_CHECK(pieces.has_value());
    configs_[at] = make_labelled_config(labels, elements, *pieces, chords_[at]);
  }
}

const LabelledCellTable& LabelledCellTable::instance() {
  static const LabelledCellTable table;
  return table;
}

}  // namespace dubsar
