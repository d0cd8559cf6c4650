#include "core/extract/labelled/labelled_pieces.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/base/result.h"

namespace dubsar {
namespace {

constexpr std::uint8_t kNoElement = 255;

bool has_bit(unsigned mask, unsigned i) { return (mask >> i) & 1u; }

/// Corners of a face, counter-clockwise seen from the higher end of its axis.
std::array<unsigned, 4> labelled_ring(unsigned face) {
  const unsigned a = face / 2, u = 1u << ((a + 1) % 3), v = 1u << ((a + 2) % 3), origin = (face & 1u) << a;
  return {origin, origin | u, origin | u | v, origin | v};
}

/// Mask of the two labels at an edge.
unsigned labels_at(const CornerLabels& labels, unsigned edge) {
  const auto [low, high] = edge_corners(edge);
  return 1u << labels[low] | 1u << labels[high];
}

bool is_active(const CornerLabels& labels, unsigned edge) { return std::popcount(labels_at(labels, edge)) == 2; }

/// Small sets that are joined.
struct JoinedSets {
  std::array<std::uint8_t, 24> parent;
  JoinedSets() { std::iota(parent.begin(), parent.end(), std::uint8_t{0}); }
  std::uint8_t root(std::uint8_t i) const {
    while (parent[i] != i) i = parent[i];
    return i;
  }
  void join(std::uint8_t a, std::uint8_t b) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    parent[high] = low;
  }
};

/// The elements that meet at each edge.
using EdgeElements = std::array<std::array<std::uint8_t, 2>, 12>;

EdgeElements elements_at_edges(const std::vector<FaceElement>& elements) {
  EdgeElements at;
  for (auto& pair : at) pair.fill(kNoElement);
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (std::size_t k = 0; k < elements[i].count; ++k) {
      auto& pair = at[elements[i].edges[k]];
      (pair[0] == kNoElement ? pair[0] : pair[1]) = static_cast<std::uint8_t>(i);
    }
  return at;
}

/// Does each label have one closed curve of three crossings or more in the piece?
bool has_simple_curves(const CornerLabels& labels, const std::vector<FaceElement>& elements,
                       const std::vector<std::uint8_t>& piece, std::uint8_t number, const LabelledChords& chords,
                       const EdgeElements& at) {
  unsigned crossings = 0;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (piece[i] == number)
      for (std::size_t k = 0; k < elements[i].count; ++k) crossings |= 1u << elements[i].edges[k];
  for (unsigned label = 0; label < 3; ++label) {
    JoinedSets curves;
    const auto join = [&](std::span<const std::uint8_t> edges) {
      std::uint8_t first = kNoElement;
      for (const std::uint8_t e : edges) {
        if (!has_bit(labels_at(labels, e), label)) continue;
        if (first == kNoElement) first = e;
        curves.join(first, e);
      }
    };
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (piece[i] == number) join(std::span(elements[i].edges).first(elements[i].count));
    for (const LabelledChord& chord : chords)
      if (piece[at[chord.edges[0]][0]] == number || piece[at[chord.edges[0]][1]] == number)
        join(std::span(chord.edges).first(chord.is_y() ? 3 : 2));
    int count = 0, size = 0;
    for (std::uint8_t e = 0; e < 12; ++e) {
      if (!has_bit(crossings, e) || !has_bit(labels_at(labels, e), label)) continue;
      ++size;
      count += curves.root(e) == e;
    }
    if (count > 1 || (count == 1 && size < 3)) return false;
  }
  return true;
}

}  // namespace

std::array<unsigned, 4> face_edges(unsigned face) {
  const unsigned u = (face / 2 + 1) % 3, v = (face / 2 + 2) % 3, side = face & 1u;
  // Along u at the low and the high side of v, along v at those of u. The axis of the face is v's u, and u's v.
  return {4 * u + 2 * side, 4 * v + side + 2, 4 * u + 1 + 2 * side, 4 * v + side};
}

std::uint8_t faces_in_turn(const CornerLabels& labels) {
  unsigned faces = 0;
  for (unsigned f = 0; f < 6; ++f) {
    const auto ring = labelled_ring(f);
    if (labels[ring[0]] == labels[ring[2]] && labels[ring[1]] == labels[ring[3]] && labels[ring[0]] != labels[ring[1]])
      faces |= 1u << f;
  }
  return static_cast<std::uint8_t>(faces);
}

std::vector<FaceElement> face_elements(const CornerLabels& labels, unsigned resolution) {
  std::vector<FaceElement> elements;
  const unsigned in_turn = faces_in_turn(labels);
  unsigned seen = 0;
  for (std::uint8_t f = 0; f < 6; ++f) {
    const auto ring = labelled_ring(f);
    const auto edges = face_edges(f);  // edges[i] lies between ring[i] and ring[i + 1]
    const bool joined = has_bit(in_turn, f) && has_bit(resolution, seen++);
    FaceElement all{f, 0, {}};
    unsigned active = 0;
    for (unsigned i = 0; i < 4; ++i) {
      if (!is_active(labels, edges[i])) continue;
      ++active;
      if (all.count < 3) all.edges[all.count++] = static_cast<std::uint8_t>(edges[i]);
    }
    if (active == 0) continue;
    if (active < 4) {
      elements.push_back(all);
      continue;
    }
    // Two corners are cut off: those of the label that is not joined, or the two that are alone in having theirs.
    unsigned cut = labels[ring[0]] == labels[ring[2]] ? 1 : 0;
    if (has_bit(in_turn, f) && (labels[ring[cut]] > labels[ring[1 - cut]]) == joined) cut = 1 - cut;
    for (const unsigned corner : {cut, cut + 2}) {
      const auto before = static_cast<std::uint8_t>(edges[(corner + 3) % 4]),
                 behind = static_cast<std::uint8_t>(edges[corner]);
      elements.push_back({f, 2, {before, behind, 0}});
    }
  }
  return elements;
}

std::optional<ElementPieces> cut_pieces(const CornerLabels& labels, const std::vector<FaceElement>& elements,
                                        const LabelledChords& chords) {
  // One chord after the other. A piece hangs together through crossings that are not cut, and along the chords at it.
  const EdgeElements at = elements_at_edges(elements);
  unsigned cut = 0;
  std::vector<std::array<std::uint8_t, 2>> along;
  const auto joined_sets = [&] {
    JoinedSets joined;
    for (unsigned e = 0; e < 12; ++e)
      if (at[e][0] != kNoElement && !has_bit(cut, e)) joined.join(at[e][0], at[e][1]);
    for (const auto& [a, b] : along) joined.join(a, b);
    return joined;
  };
  for (const LabelledChord& chord : chords) {
    const auto edges = std::span(chord.edges).first(chord.is_y() ? 3 : 2);
    for (const std::uint8_t e : edges) {
      if (has_bit(cut, e)) return std::nullopt;  // two chords at a crossing
      cut |= 1u << e;
    }
    const JoinedSets joined = joined_sets();
    const auto [p, q] = at[edges[0]];
    if (joined.root(p) == joined.root(q)) return std::nullopt;
    for (const std::uint8_t e : edges.subspan(1)) {
      const bool same = joined.root(at[e][0]) == joined.root(p);
      const std::uint8_t at_p = at[e][same ? 0 : 1], at_q = at[e][same ? 1 : 0];
      if (joined.root(at_p) != joined.root(p) || joined.root(at_q) != joined.root(q)) return std::nullopt;
      along.push_back({p, at_p});
      along.push_back({q, at_q});
    }
  }

  const JoinedSets joined = joined_sets();
  ElementPieces pieces;
  std::array<std::uint8_t, 24> number;
  number.fill(kNoElement);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    std::uint8_t& name = number[joined.root(static_cast<std::uint8_t>(i))];
    if (name == kNoElement) name = static_cast<std::uint8_t>(pieces.count++);
    pieces.piece.push_back(name);
  }
  std::vector<std::pair<std::uint8_t, std::uint8_t>> between;
  for (const LabelledChord& chord : chords) {
    const auto& [a, b] = at[chord.edges[0]];
    const std::pair<std::uint8_t, std::uint8_t> here = std::minmax({pieces.piece[a], pieces.piece[b]});
    if (here.first == here.second || std::find(between.begin(), between.end(), here) != between.end())
      return std::nullopt;
    between.push_back(here);
  }
  for (std::size_t i = 0; i + 1 < elements.size(); ++i)  // the two of a face follow one another
    if (elements[i].face == elements[i + 1].face && pieces.piece[i] == pieces.piece[i + 1]) return std::nullopt;
  for (std::uint8_t p = 0; p < pieces.count; ++p) {
    if (!has_simple_curves(labels, elements, pieces.piece, p, chords, at)) return std::nullopt;
    unsigned crossings = 0;
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (pieces.piece[i] == p)
        for (std::size_t k = 0; k < elements[i].count; ++k) crossings |= 1u << elements[i].edges[k];
    pieces.squares += std::popcount(crossings) * std::popcount(crossings);
  }
  return pieces;
}

std::vector<LabelledChords> best_chords(const CornerLabels& labels, const std::vector<FaceElement>& elements) {
  if (cut_pieces(labels, elements, {})) return {{}};
  std::vector<LabelledChord> all;
  for (std::uint8_t e = 0; e < 12; ++e) {
    if (!is_active(labels, e)) continue;
    for (std::uint8_t f = e + 1; f < 12; ++f) {
      if (!is_active(labels, f)) continue;
      if (labels_at(labels, e) == labels_at(labels, f)) {
        all.push_back({{e, f, LabelledChord::kNone}});
        continue;
      }
      for (std::uint8_t g = f + 1; g < 12; ++g)
        if (is_active(labels, g) && (labels_at(labels, e) ^ labels_at(labels, f)) == labels_at(labels, g))
          all.push_back({{e, f, g}});
    }
  }
  std::vector<LabelledChords> best;
  int least = 0;
  const auto consider = [&](LabelledChords chords) {
    const auto pieces = cut_pieces(labels, elements, chords);
    if (!pieces) return;
    if (best.empty() || pieces->squares < least) best.clear(), least = pieces->squares;
    if (pieces->squares == least) best.push_back(std::move(chords));
  };
  for (const LabelledChord& chord : all) consider({chord});
  if (best.empty())
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) consider({all[i], all[j]});
  for (LabelledChords& chords : best) std::sort(chords.begin(), chords.end());
  DUBSAR_CHECK(!best.empty());
  return best;
}

LabelledConfig make_labelled_config(const CornerLabels& labels, const std::vector<FaceElement>& elements,
                                    const ElementPieces& pieces, const LabelledChords& chords) {
  DUBSAR_CHECK(pieces.count <= 4);
  LabelledConfig config;
  config.vertices = static_cast<std::uint8_t>(pieces.count);
  std::array<std::array<std::uint8_t, 6>, 12> piece_at{};  // [edge][face]
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::uint8_t p = pieces.piece[i];
    if (elements[i].count == 3) config.triple |= static_cast<std::uint8_t>(1u << p);
    for (std::size_t k = 0; k < elements[i].count; ++k) {
      const std::uint8_t e = elements[i].edges[k];
      piece_at[e][elements[i].face] = p;
      config.piece_edges[p] |= static_cast<std::uint16_t>(1u << e);
      config.active_edges |= static_cast<std::uint16_t>(1u << e);
    }
  }
  constexpr std::array<std::uint8_t, 4> kTurns = {0, 1, 3, 2};  // by ou + 2 ov, as in cell_table.cpp
  for (unsigned e = 0; e < 12; ++e) {
    if (!has_bit(config.active_edges, e)) continue;
    const unsigned a = e / 4, ou = e & 1u, ov = (e >> 1) & 1u;
    const std::uint8_t at_u = piece_at[e][2 * ((a + 1) % 3) + ou], at_v = piece_at[e][2 * ((a + 2) % 3) + ov];
    const auto [low, high] = edge_corners(e);
    const bool forward = labels[low] > labels[high];
    const std::uint8_t turn = kTurns[ou + 2 * ov];
    const bool enters_across_v = (turn % 2 == 0) == forward;
    config.corners[e].corner = static_cast<std::uint8_t>(forward ? turn : (4 - turn) % 4);
    config.corners[e].first = enters_across_v ? at_v : at_u;
    config.corners[e].second = enters_across_v ? at_u : at_v;
  }
  for (const LabelledChord& chord : chords)
    if (chord.is_y())
      for (const std::uint8_t p : {config.corners[chord.edges[0]].first, config.corners[chord.edges[0]].second})
        config.triple |= static_cast<std::uint8_t>(1u << p);
  return config;
}

}  // namespace dubsar
