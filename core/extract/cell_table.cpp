#include "core/extract/cell_table.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "core/base/result.h"

namespace dubsar {
namespace {

using ChordSet = std::vector<CellChord>;  // sorted

bool bit(unsigned mask, unsigned i) { return (mask >> i) & 1u; }

unsigned edge_between(unsigned c0, unsigned c1) {
  const unsigned a = static_cast<unsigned>(std::countr_zero(c0 ^ c1));
  const unsigned low = std::min(c0, c1);
  return 4 * a + ((low >> ((a + 1) % 3)) & 1u) + 2 * ((low >> ((a + 2) % 3)) & 1u);
}

/// Corners of a face, counter-clockwise seen from outside the cell.
std::array<unsigned, 4> face_ring(unsigned face) {
  const unsigned a = face / 2, u = 1u << ((a + 1) % 3), v = 1u << ((a + 2) % 3);
  const unsigned origin = (face & 1u) << a;
  if (face & 1u) return {origin, origin | u, origin | u | v, origin | v};
  return {origin, origin | v, origin | u | v, origin | u};
}

bool is_ambiguous(unsigned signs, unsigned face) {
  const auto ring = face_ring(face);
  return bit(signs, ring[0]) == bit(signs, ring[2]) && bit(signs, ring[1]) == bit(signs, ring[3]) &&
         bit(signs, ring[0]) != bit(signs, ring[1]);
}

/// Steps 1 and 2: the segments on the faces, joined to directed closed curves.
std::vector<CellCycle> walk_cycles(unsigned signs, unsigned ambiguous, unsigned resolution) {
  constexpr std::uint8_t kNone = 255;
  std::array<std::uint8_t, 12> next, through;
  next.fill(kNone);
  through.fill(kNone);
  unsigned ambiguous_seen = 0;
  for (unsigned face = 0; face < 6; ++face) {
    const auto ring = face_ring(face);
    const auto ring_edge = [&](unsigned i) { return edge_between(ring[i % 4], ring[(i + 1) % 4]); };
    const bool joined = bit(ambiguous, face) && bit(resolution, ambiguous_seen++);
    // From each edge where the ring leaves the inside to the one where it comes back; where inside corners are not
    // joined, to the one where this inside corner was entered.
    for (unsigned i = 0; i < 4; ++i) {
      if (!bit(signs, ring[i]) || bit(signs, ring[(i + 1) % 4])) continue;
      unsigned back = i + 1;
      while (!bit(signs, ring[(back + 1) % 4])) ++back;
      if (bit(ambiguous, face) && !joined) back = i + 3;
      next[ring_edge(i)] = static_cast<std::uint8_t>(ring_edge(back));
      through[ring_edge(i)] = static_cast<std::uint8_t>(face);
    }
  }
  std::vector<CellCycle> cycles;
  unsigned visited = 0;
  for (std::uint8_t start = 0; start < 12; ++start) {
    if (next[start] == kNone || bit(visited, start)) continue;
    CellCycle cycle;
    std::array<int, 6> crossings{};
    for (std::uint8_t e = start; !bit(visited, e); e = next[e]) {
      visited |= 1u << e;
      cycle.edges.push_back(e);
      cycle.faces.push_back(through[e]);
      if (++crossings[through[e]] == 2) cycle.pinched |= static_cast<std::uint8_t>(1u << through[e]);
    }
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

/// Which piece of the curve each segment belongs to; pieces numbered in order of their first segment.
std::vector<unsigned> split_cycle(const CellCycle& cycle, const ChordSet& chords) {
  const std::size_t n = cycle.edges.size();
  const auto place = [&](std::uint8_t edge) {
    return static_cast<std::size_t>(std::find(cycle.edges.begin(), cycle.edges.end(), edge) - cycle.edges.begin());
  };
  std::vector<unsigned> side(n, 0);  // bit per chord; non-crossing chords: equal bits = same piece
  for (std::size_t k = 0; k < chords.size(); ++k) {
    const auto [i, j] = std::minmax({place(chords[k].a), place(chords[k].b)});
    if (j == n) continue;  // a chord of another curve
    for (std::size_t s = i; s < j; ++s) side[s] |= 1u << k;
  }
  std::vector<unsigned> names, piece(n);
  for (std::size_t s = 0; s < n; ++s) {
    const auto found = std::find(names.begin(), names.end(), side[s]);
    piece[s] = static_cast<unsigned>(found - names.begin());
    if (found == names.end()) names.push_back(side[s]);
  }
  return piece;
}

bool separates_pinched_faces(const CellCycle& cycle, const std::vector<unsigned>& piece) {
  for (std::size_t i = 0; i < piece.size(); ++i) {
    for (std::size_t j = i + 1; j < piece.size(); ++j) {
      if (cycle.faces[i] == cycle.faces[j] && piece[i] == piece[j]) return false;
    }
  }
  return true;
}

/// Number of crossings of each piece: its segments and one more for each of its chords.
std::vector<int> piece_sizes(const CellCycle& cycle, const std::vector<unsigned>& piece) {
  std::vector<unsigned> edges(*std::max_element(piece.begin(), piece.end()) + 1, 0);
  for (std::size_t s = 0; s < piece.size(); ++s) {
    edges[piece[s]] |= 1u << cycle.edges[s] | 1u << cycle.edges[(s + 1) % piece.size()];
  }
  std::vector<int> sizes(edges.size());
  std::transform(edges.begin(), edges.end(), sizes.begin(), [](unsigned mask) { return std::popcount(mask); });
  return sizes;
}

/// Step 3 for one curve: all smallest sets of non-crossing chords, no two at one crossing, that put the two segments
/// of every pinched face in different pieces; only the most balanced of them.
std::vector<ChordSet> cycle_splits(const CellCycle& cycle) {
  if (cycle.pinched == 0) return {{}};
  const std::size_t n = cycle.edges.size();
  struct Span {
    std::size_t i, j;
  };
  std::vector<Span> spans;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n && j - i + 2 <= n; ++j) spans.push_back({i, j});
  }
  std::vector<ChordSet> best;
  long best_cost = 0;
  const auto consider = [&](ChordSet chords) {
    std::sort(chords.begin(), chords.end());
    const auto piece = split_cycle(cycle, chords);
    if (!separates_pinched_faces(cycle, piece)) return;
    long cost = 0;
    for (const int size : piece_sizes(cycle, piece)) cost += static_cast<long>(size) * size;
    if (best.empty() || cost < best_cost) best.clear(), best_cost = cost;
    if (cost == best_cost) best.push_back(std::move(chords));
  };
  const auto chord = [&](const Span& s) {
    const auto [a, b] = std::minmax(cycle.edges[s.i], cycle.edges[s.j]);
    return CellChord{a, b};
  };
  for (const Span& s : spans) consider({chord(s)});
  if (!best.empty()) return best;
  for (std::size_t k = 0; k < spans.size(); ++k) {
    for (std::size_t l = k + 1; l < spans.size(); ++l) {
      const Span s = spans[k], t = spans[l];
      const bool shared = s.i == t.i || s.i == t.j || s.j == t.i || s.j == t.j;
      const auto within = [&](std::size_t x) { return x > s.i && x < s.j; };
      if (!shared && within(t.i) == within(t.j)) consider({chord(s), chord(t)});
    }
  }
  DUBSAR_CHECK(!best.empty());
  return best;
}

/// All best splits of all curves of a cell together.
std::vector<ChordSet> cell_splits(const std::vector<CellCycle>& cycles) {
  std::vector<ChordSet> all{{}};
  for (const CellCycle& cycle : cycles) {
    std::vector<ChordSet> longer;
    for (const ChordSet& head : all) {
      for (const ChordSet& tail : cycle_splits(cycle)) {
        ChordSet joined = head;
        joined.insert(joined.end(), tail.begin(), tail.end());
        std::sort(joined.begin(), joined.end());
        longer.push_back(std::move(joined));
      }
    }
    all = std::move(longer);
  }
  return all;
}

ChordSet transform_chords(const ChordSet& chords, const CellSymmetry& symmetry) {
  ChordSet image;
  for (const CellChord& chord : chords) {
    const auto [a, b] = std::minmax(symmetry.edge[chord.a], symmetry.edge[chord.b]);
    image.push_back({a, b});
  }
  std::sort(image.begin(), image.end());
  return image;
}

/// The lexicographically first split that every symmetry of the configuration in `group` maps to itself.
std::optional<ChordSet> symmetric_split(const CellTable& table, int id, std::vector<ChordSet> splits,
                                        const std::vector<CellSymmetry>& group) {
  std::sort(splits.begin(), splits.end());
  for (const ChordSet& split : splits) {
    if (std::all_of(group.begin(), group.end(), [&](const CellSymmetry& g) {
          return transform_config(table, id, g) != id || transform_chords(split, g) == split;
        })) {
      return split;
    }
  }
  return std::nullopt;
}

CellConfig make_config(unsigned signs, const std::vector<CellCycle>& cycles, const ChordSet& chords) {
  CellConfig config;
  std::array<std::array<std::uint8_t, 6>, 12> piece_at{};  // [edge][face]
  unsigned first_piece = 0;
  for (const CellCycle& cycle : cycles) {
    const auto piece = split_cycle(cycle, chords);
    const std::size_t n = piece.size();
    for (std::size_t s = 0; s < n; ++s) {
      const unsigned p = first_piece + piece[s];
      const std::uint8_t from = cycle.edges[s], to = cycle.edges[(s + 1) % n], face = cycle.faces[s];
      piece_at[from][face] = piece_at[to][face] = static_cast<std::uint8_t>(p);
      config.piece_edges[p] |= static_cast<std::uint16_t>(1u << from | 1u << to);
      config.active_edges |= static_cast<std::uint16_t>(1u << from);
    }
    first_piece += *std::max_element(piece.begin(), piece.end()) + 1;
  }
  config.vertices = static_cast<std::uint8_t>(first_piece);
  for (const std::uint16_t edges : config.piece_edges) {
    config.incidences = static_cast<std::uint8_t>(config.incidences + std::popcount(edges));
  }
  for (unsigned e = 0; e < 12; ++e) {
    if (!bit(config.active_edges, e)) continue;
    const unsigned a = e / 4, ou = e & 1u, ov = (e >> 1) & 1u;
    const std::uint8_t at_u = piece_at[e][2 * ((a + 1) % 3) + ou];
    const std::uint8_t at_v = piece_at[e][2 * ((a + 2) % 3) + ov];
    // Counter-clockwise seen from +a the cells at (+u,+v), (-u,+v), (-u,-v), (+u,-v) follow one another, and the first
    // is entered through the face across v. With the air at -a the order is the reverse.
    constexpr std::array<std::uint8_t, 4> kTurn = {0, 1, 3, 2};  // by ou + 2 ov
    const std::uint8_t turn = kTurn[ou + 2 * ov];
    const bool forward = bit(signs, edge_corners(e)[0]);
    const bool enters_across_v = (turn % 2 == 0) == forward;
    config.corners[e].corner = static_cast<std::uint8_t>(forward ? turn : (4 - turn) % 4);
    config.corners[e].first = enters_across_v ? at_v : at_u;
    config.corners[e].second = enters_across_v ? at_u : at_v;
  }
  constexpr std::array<std::uint8_t, 12> kRisingEdges = {0, 4, 6, 8, 9, 1, 10, 11, 2, 5, 7, 3};  // rows z, y; axis; x
  for (unsigned p = 0; p < config.vertices; ++p) {
    CellPiece& piece = config.pieces[p];
    for (const std::uint8_t e : kRisingEdges) {
      if (!bit(config.piece_edges[p], e)) continue;
      const std::uint8_t axis = e / 4;
      const CellCorner& corner = config.corners[e];
      piece.edges[piece.count++] = {e, axis, corner.corner, corner.first != p};
      if (e & 1u) ++piece.high[(axis + 1u) % 3];
      if (e & 2u) ++piece.high[(axis + 2u) % 3];
    }
  }
  return config;
}

}  // namespace

const std::vector<CellSymmetry>& cell_symmetries() {
  static const std::vector<CellSymmetry> symmetries = [] {
    std::vector<CellSymmetry> all;
    std::array<unsigned, 3> axis = {0, 1, 2};
    do {
      for (unsigned flips = 0; flips < 8; ++flips) {
        CellSymmetry g;
        g.axes_fixed = axis[0] == 0 && axis[1] == 1;
        for (unsigned c = 0; c < 8; ++c) {
          unsigned image = 0;
          for (unsigned a = 0; a < 3; ++a) image |= ((c >> a & 1u) ^ (flips >> a & 1u)) << axis[a];
          g.corner[c] = static_cast<std::uint8_t>(image);
        }
        for (unsigned e = 0; e < 12; ++e) {
          const auto [low, high] = edge_corners(e);
          g.edge[e] = static_cast<std::uint8_t>(edge_between(g.corner[low], g.corner[high]));
        }
        for (unsigned f = 0; f < 6; ++f) {
          g.face[f] = static_cast<std::uint8_t>(2 * axis[f / 2] + ((f & 1u) ^ (flips >> (f / 2) & 1u)));
        }
        for (const bool inverted : {false, true}) {
          g.inverted = inverted;
          all.push_back(g);
        }
      }
    } while (std::next_permutation(axis.begin(), axis.end()));
    return all;
  }();
  return symmetries;
}

int transform_config(const CellTable& table, int id, const CellSymmetry& symmetry) {
  const unsigned from = table.signs(id), resolution = table.resolution(id);
  unsigned signs = 0;
  for (unsigned c = 0; c < 8; ++c) signs |= unsigned{bit(from, c) != symmetry.inverted} << symmetry.corner[c];
  unsigned joined = 0, seen = 0;  // joined: bit per face
  for (unsigned f = 0; f < 6; ++f) {
    if (!bit(table.ambiguous_faces(from), f)) continue;
    joined |= unsigned{bit(resolution, seen++) != symmetry.inverted} << symmetry.face[f];
  }
  unsigned image = 0, place = 0;
  for (unsigned f = 0; f < 6; ++f) {
    if (bit(table.ambiguous_faces(signs), f)) image |= unsigned{bit(joined, f)} << place++;
  }
  return table.id(signs, image);
}

CellTable::CellTable() {
  int count = 0;
  for (unsigned signs = 0; signs < 256; ++signs) {
    for (unsigned f = 0; f < 6; ++f) {
      if (is_ambiguous(signs, f)) ambiguous_[signs] |= static_cast<std::uint8_t>(1u << f);
    }
    base_[signs] = static_cast<std::uint16_t>(count);
    for (unsigned r = 0; r < 1u << std::popcount(ambiguous_[signs]); ++r, ++count) {
      DUBSAR_CHECK(count < kConfigs);
      signs_[static_cast<std::size_t>(count)] = static_cast<std::uint8_t>(signs);
      cycles_[static_cast<std::size_t>(count)] = walk_cycles(signs, ambiguous_[signs], r);
    }
  }
  DUBSAR_CHECK(count == kConfigs);

  // One split for each class of configurations, carried to the others by the symmetries, so that a mirrored or turned
  // volume gives the mirrored or turned mesh. In five classes the curves have a symmetry that no smallest set of chords
  // has. There as much of the group is kept as can be: the mirrors in four of them, the exchange of inside and outside
  // in all.
  std::vector<CellSymmetry> mirrors, inversions;
  for (const CellSymmetry& g : cell_symmetries()) {
    if (g.axes_fixed) mirrors.push_back(g);
    if (g.corner[1] == 1 && g.corner[2] == 2 && g.corner[4] == 4) inversions.push_back(g);
  }
  std::array<bool, kConfigs> done{};
  for (int id = 0; id < kConfigs; ++id) {
    if (done[static_cast<std::size_t>(id)]) continue;
    const std::vector<ChordSet> splits = cell_splits(cycles_[static_cast<std::size_t>(id)]);
    std::optional<ChordSet> split;
    for (const auto* group : {&cell_symmetries(), &std::as_const(mirrors), &std::as_const(inversions)}) {
      split = symmetric_split(*this, id, splits, *group);
      if (!split) continue;
      for (const CellSymmetry& g : *group) {
        const auto image = static_cast<std::size_t>(transform_config(*this, id, g));
        done[image] = true;
        chords_[image] = transform_chords(*split, g);
      }
      break;
    }
    DUBSAR_CHECK(split.has_value());
  }
  for (std::size_t id = 0; id < kConfigs; ++id) configs_[id] = make_config(signs_[id], cycles_[id], chords_[id]);
}

const CellTable& CellTable::instance() {
  static const CellTable table;
  return table;
}

}  // namespace dubsar
