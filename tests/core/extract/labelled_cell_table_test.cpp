#include "core/extract/labelled/labelled_cell_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <numeric>
#include <set>

namespace dubsar {
namespace {

const LabelledCellTable& labelled() { return LabelledCellTable::instance(); }

CornerLabels corners_of(int id) { return LabelledCellTable::labels_of(labelled().labelling_of(id)); }

int label_count(int id) {
  const CornerLabels labels = corners_of(id);
  return static_cast<int>(std::set<int>(labels.begin(), labels.end()).size());
}

/// Smallest image of a configuration under the symmetries: the name of its class.
int labelled_class(int id) {
  static const std::vector<int> classes = [] {
    std::vector<int> all(LabelledCellTable::kConfigs, -1);
    for (int first = 0; first < LabelledCellTable::kConfigs; ++first) {
      if (all[static_cast<std::size_t>(first)] >= 0) continue;
      for (const LabelledSymmetry& g : labelled_symmetries())
        all[static_cast<std::size_t>(transform_config(labelled(), first, g))] = first;
    }
    return all;
  }();
  return classes[static_cast<std::size_t>(id)];
}

TEST(LabelledCellTable, Has10578ConfigurationsWithActiveEdgesIn88Classes) {
  std::set<int> classes, of_three;
  int active = 0;
  std::map<int, int> labels;
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    EXPECT_EQ(labelled().id(labelled().labelling_of(id), labelled().resolution(id)), id);
    EXPECT_EQ(labelled().config(id).active_edges != 0, label_count(id) > 1);
    ++labels[label_count(id)];
    if (label_count(id) == 1) continue;
    ++active;
    classes.insert(labelled_class(id));
    if (label_count(id) == 3) of_three.insert(labelled_class(id));
  }
  EXPECT_EQ(active, 10578);
  EXPECT_EQ(labels, (std::map<int, int>{{1, 3}, {2, 3 * 654}, {3, 8616}}));
  EXPECT_EQ(classes.size(), 88u);
  EXPECT_EQ(of_three.size(), 62u);
}

TEST(LabelledCellTable, ThreeLabelsHaveTheKnownNumbersOfPiecesAndChords) {
  std::map<int, int> pieces;
  std::map<std::size_t, int> chords;
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    if (label_count(id) != 3) continue;
    ++pieces[labelled().config(id).vertices];
    ++chords[labelled().chords(id).size()];
  }
  EXPECT_EQ(pieces, (std::map<int, int>{{1, 1368}, {2, 5832}, {3, 1080}, {4, 336}}));
  EXPECT_EQ(chords, (std::map<std::size_t, int>{{0, 3504}, {1, 5076}, {2, 36}}));
}

TEST(LabelledCellTable, TwoLabelsAreTodaysTableWithTheHigherOneInside) {
  const CellTable& two = CellTable::instance();
  for (unsigned low = 0; low < 3; ++low)
    for (unsigned high = low + 1; high < 3; ++high)
      for (int known = 1; known + 1 < CellTable::kConfigs; ++known) {
        CornerLabels labels;
        for (unsigned c = 0; c < 8; ++c) labels[c] = static_cast<std::uint8_t>(two.signs(known) >> c & 1u ? high : low);
        const int id = labelled().id(LabelledCellTable::labelling(labels), two.resolution(known));
        const LabelledConfig& found = labelled().config(id);
        const CellConfig& wanted = two.config(known);
        EXPECT_EQ(found.active_edges, wanted.active_edges);
        EXPECT_EQ(found.vertices, wanted.vertices);
        EXPECT_EQ(found.piece_edges, wanted.piece_edges);
        EXPECT_EQ(found.triple, 0);
        for (std::size_t e = 0; e < 12; ++e) {
          EXPECT_EQ(found.corners[e].corner, wanted.corners[e].corner);
          EXPECT_EQ(found.corners[e].first, wanted.corners[e].first);
          EXPECT_EQ(found.corners[e].second, wanted.corners[e].second);
        }
      }
}

// --- An own account of what runs over the faces of a cell, by the coordinates of its corners.

using Corner = std::array<int, 3>;
struct Crossing {
  Corner from, to;
  auto operator<=>(const Crossing&) const = default;
};
struct Element {
  int face;
  std::vector<Crossing> crossings;
};

int number_of(const Corner& c) { return c[0] + 2 * c[1] + 4 * c[2]; }
int edge_number(const Crossing& x) {
  int axis = 0;
  while (x.from[static_cast<std::size_t>(axis)] == x.to[static_cast<std::size_t>(axis)]) ++axis;
  return 4 * axis + x.from[static_cast<std::size_t>((axis + 1) % 3)] +
         2 * x.from[static_cast<std::size_t>((axis + 2) % 3)];
}

std::vector<Element> elements_of(int id) {
  const CornerLabels labels = corners_of(id);
  std::vector<Element> all;
  unsigned bits = labelled().resolution(id);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      std::array<Corner, 4> ring;
      for (int i = 0; i < 4; ++i) {
        Corner& c = ring[static_cast<std::size_t>(i)];
        c[static_cast<std::size_t>(axis)] = side;
        c[static_cast<std::size_t>((axis + 1) % 3)] = i == 1 || i == 2;
        c[static_cast<std::size_t>((axis + 2) % 3)] = i >= 2;
      }
      const auto label = [&](int i) {
        return labels[static_cast<std::size_t>(number_of(ring[static_cast<std::size_t>(i & 3)]))];
      };
      const auto crossing = [&](int i) {
        Crossing x{ring[static_cast<std::size_t>(i & 3)], ring[static_cast<std::size_t>((i + 1) & 3)]};
        if (x.to < x.from) std::swap(x.from, x.to);
        return x;
      };
      Element element{2 * axis + side, {}};
      for (int i = 0; i < 4; ++i)
        if (label(i) != label(i + 1)) element.crossings.push_back(crossing(i));
      if (element.crossings.empty()) continue;
      if (element.crossings.size() < 4) {
        all.push_back(element);
        continue;
      }
      int cut;  // the first of the two corners that are cut off, opposite each other
      if (label(0) == label(2) && label(1) == label(3)) {
        const bool higher_joined = bits & 1u;
        bits >>= 1;
        cut = (label(0) > label(1)) == higher_joined ? 1 : 0;
      } else {
        cut = label(0) == label(2) ? 1 : 0;
      }
      for (const int c : {cut, cut + 2}) all.push_back({2 * axis + side, {crossing(c + 3), crossing(c)}});
    }
  return all;
}

bool has_label(int id, const Crossing& x, int label) {
  const CornerLabels labels = corners_of(id);
  return labels[static_cast<std::size_t>(number_of(x.from))] == label ||
         labels[static_cast<std::size_t>(number_of(x.to))] == label;
}

/// The piece in which the polygon of an edge crosses a face of the cell.
unsigned piece_at(int id, const Crossing& x, int face) {
  const int e = edge_number(x), axis = e / 4, ou = e & 1, ov = e >> 1 & 1;
  const CellCorner& corner = labelled().config(id).corners[static_cast<std::size_t>(e)];
  const CornerLabels labels = corners_of(id);
  const bool forward =
      labels[static_cast<std::size_t>(number_of(x.from))] > labels[static_cast<std::size_t>(number_of(x.to))];
  // Seen from the end with the lower label the cells (+u+v), (-u+v), (-u-v), (+u-v), or their mirror, come in turn.
  const bool across_v_first = (ou == ov) == forward;
  const bool across_v = face / 2 == (axis + 2) % 3;
  EXPECT_EQ(face, across_v ? 2 * ((axis + 2) % 3) + ov : 2 * ((axis + 1) % 3) + ou);
  return across_v == across_v_first ? corner.first : corner.second;
}

TEST(LabelledCellTable, EveryElementOfAFaceLiesInOnePiece) {
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    const LabelledConfig& config = labelled().config(id);
    std::array<unsigned, 4> edges{};
    for (const Element& element : elements_of(id)) {
      const unsigned p = piece_at(id, element.crossings[0], element.face);
      for (const Crossing& x : element.crossings) {
        ASSERT_EQ(piece_at(id, x, element.face), p) << id;
        edges[p] |= 1u << edge_number(x);
      }
      ASSERT_TRUE(element.crossings.size() < 3 || (config.triple >> p & 1u)) << id;
    }
    for (unsigned p = 0; p < 4; ++p) {
      ASSERT_EQ(edges[p], config.piece_edges[p]) << id;
      ASSERT_EQ(edges[p] != 0, p < config.vertices) << id;
    }
  }
}

TEST(LabelledCellTable, TheTwoSegmentsOfAFaceLieInDifferentPieces) {
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    std::set<std::pair<int, unsigned>> seen;
    for (const Element& element : elements_of(id))
      ASSERT_TRUE(seen.insert({element.face, piece_at(id, element.crossings[0], element.face)}).second) << id;
  }
}

TEST(LabelledCellTable, EveryLabelHasOneClosedCurveInEveryPiece) {
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    const std::vector<Element> elements = elements_of(id);
    for (int label = 0; label < 3; ++label)
      for (unsigned p = 0; p < labelled().config(id).vertices; ++p) {
        std::map<Crossing, std::vector<Crossing>> beside;
        const auto join = [&](const std::vector<Crossing>& of) {
          std::vector<Crossing> two;
          std::ranges::copy_if(of, std::back_inserter(two), [&](const Crossing& x) { return has_label(id, x, label); });
          if (two.empty()) return;
          ASSERT_EQ(two.size(), 2u) << id;
          beside[two[0]].push_back(two[1]);
          beside[two[1]].push_back(two[0]);
        };
        std::vector<Crossing> crossings;
        for (const Element& element : elements) {
          crossings.insert(crossings.end(), element.crossings.begin(), element.crossings.end());
          if (piece_at(id, element.crossings[0], element.face) == p) join(element.crossings);
        }
        for (const LabelledChord& chord : labelled().chords(id)) {
          std::vector<Crossing> ends;
          std::set<unsigned> sides;
          for (const std::uint8_t e : chord.edges) {
            if (e == LabelledChord::kNone) continue;
            ends.push_back(*std::ranges::find_if(crossings, [&](const Crossing& x) { return edge_number(x) == e; }));
            const CellCorner& corner = labelled().config(id).corners[e];
            sides.insert(corner.first);
            sides.insert(corner.second);
          }
          ASSERT_EQ(sides.size(), 2u) << id;
          if (sides.contains(p)) join(ends);
        }
        if (beside.empty()) continue;
        ASSERT_GE(beside.size(), 3u) << id;
        std::set<Crossing> met;
        const std::function<void(const Crossing&)> walk = [&](const Crossing& x) {
          if (!met.insert(x).second) return;
          for (const Crossing& y : beside.at(x)) walk(y);
        };
        walk(beside.begin()->first);
        for (const auto& [x, others] : beside) ASSERT_EQ(others.size(), 2u) << id;
        ASSERT_EQ(met.size(), beside.size()) << id << " label " << label << " piece " << p;
      }
  }
}

TEST(LabelledCellTable, ACrossingHasOneChordAndTwoPiecesShareOne) {
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    const LabelledConfig& config = labelled().config(id);
    unsigned ends = 0;
    std::set<std::pair<unsigned, unsigned>> between;
    for (const LabelledChord& chord : labelled().chords(id)) {
      for (const std::uint8_t e : chord.edges) {
        if (e == LabelledChord::kNone) continue;
        ASSERT_FALSE(ends >> e & 1u) << id;
        ends |= 1u << e;
        ASSERT_NE(config.corners[e].first, config.corners[e].second) << id;
      }
      const CellCorner& corner = config.corners[chord.edges[0]];
      ASSERT_TRUE(between.insert(std::minmax<unsigned>(corner.first, corner.second)).second) << id;
    }
    for (unsigned e = 0; e < 12; ++e)
      if ((config.active_edges >> e & 1u) && !(ends >> e & 1u)) {
        ASSERT_EQ(config.corners[e].first, config.corners[e].second) << id;
      }
  }
}

TEST(LabelledCellTable, OnAFaceOfThreeLabelsTheOneThatIsThereTwiceIsJoined) {
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id) {
    const CornerLabels labels = corners_of(id);
    std::map<int, int> on_face;
    const auto elements = elements_of(id);
    for (const Element& element : elements) ++on_face[element.face];
    for (const Element& element : elements) {
      if (on_face[element.face] != 2) continue;
      // Its segment cuts off one corner, which both crossings have.
      const Crossing &x = element.crossings[0], &y = element.crossings[1];
      const Corner corner = x.from == y.from || x.from == y.to ? x.from : x.to;
      const Corner other_end = x.from == corner ? x.to : x.from;
      const std::uint8_t own = labels[static_cast<std::size_t>(number_of(corner))];
      // The corner opposite it has another label, or all four are two in turn.
      Corner opposite = corner;
      for (std::size_t a = 0; a < 3; ++a)
        if (static_cast<int>(a) != element.face / 2) opposite[a] = 1 - opposite[a];
      const std::uint8_t across = labels[static_cast<std::size_t>(number_of(opposite))];
      const std::uint8_t around = labels[static_cast<std::size_t>(number_of(other_end))];
      EXPECT_NE(own, around);
      EXPECT_TRUE(across == own || (across != around)) << id;
    }
  }
}

TEST(LabelledCellTable, ChordsFollowTheSymmetriesWhereTheyCan) {
  std::set<int> turned, mirrored, relabelled;
  for (int id = 0; id < LabelledCellTable::kConfigs; ++id)
    for (const LabelledSymmetry& g : labelled_symmetries()) {
      if (labelled().chords(id).empty()) continue;  // and so it is for all of its class
      std::vector<LabelledChord> image;
      for (LabelledChord chord : labelled().chords(id)) {
        for (std::uint8_t& e : chord.edges)
          if (e != LabelledChord::kNone) e = g.cell.edge[e];
        std::ranges::sort(chord.edges);
        image.push_back(chord);
      }
      std::ranges::sort(image);
      if (std::ranges::equal(image, labelled().chords(transform_config(labelled(), id, g)))) continue;
      turned.insert(labelled_class(id));
      if (g.cell.axes_fixed) mirrored.insert(labelled_class(id));
      if (g.cell.edge[1] == 1 && g.cell.edge[2] == 2 && g.cell.edge[5] == 5 && g.cell.edge[0] == 0 &&
          g.cell.edge[4] == 4)
        relabelled.insert(labelled_class(id));
    }
  // Five of two labels (CellTable), and nine of three whose configuration has a symmetry that no smallest set of chords
  // has. Exchanging labels always keeps the chords.
  EXPECT_EQ(turned.size(), 14u);
  EXPECT_EQ(mirrored.size(), 3u);
  EXPECT_EQ(relabelled.size(), 0u);
}

}  // namespace
}  // namespace dubsar
