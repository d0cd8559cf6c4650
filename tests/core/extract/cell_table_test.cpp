#include "core/extract/cell_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <set>

namespace dubsar {
namespace {

const CellTable& table() { return CellTable::instance(); }

/// Smallest image of a configuration under the symmetries: the name of its class.
int class_of(int id, bool with_inversion = true) {
  int smallest = id;
  for (const CellSymmetry& g : cell_symmetries()) {
    if (with_inversion || !g.inverted) smallest = std::min(smallest, transform_config(table(), id, g));
  }
  return smallest;
}

TEST(CellTable, Has656ConfigurationsIn328InversePairsAnd27Classes) {
  std::set<int> classes, pairs;
  CellSymmetry inversion{};
  for (const CellSymmetry& g : cell_symmetries()) {
    if (g.inverted && g.corner == std::array<std::uint8_t, 8>{0, 1, 2, 3, 4, 5, 6, 7}) inversion = g;
  }
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    EXPECT_EQ(table().id(table().signs(id), table().resolution(id)), id);
    classes.insert(class_of(id));
    pairs.insert(std::min(id, transform_config(table(), id, inversion)));
  }
  EXPECT_EQ(table().id(255, 0), CellTable::kConfigs - 1);
  EXPECT_EQ(pairs.size(), 328u);
  EXPECT_EQ(classes.size(), 27u);
}

TEST(CellTable, SplitsElevenOf26ClassesIn344Configurations) {
  std::map<int, bool> split_classes;
  int split_configs = 0;
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    if (table().cycles(id).empty()) continue;
    const bool split = !table().chords(id).empty();
    split_configs += split;
    const auto [place, is_new] = split_classes.emplace(class_of(id), split);
    EXPECT_TRUE(is_new || place->second == split) << "one class, two decisions, at " << id;
  }
  EXPECT_EQ(split_configs, 344);
  EXPECT_EQ(split_classes.size(), 26u);
  EXPECT_EQ(std::count_if(split_classes.begin(), split_classes.end(), [](const auto& c) { return c.second; }), 11);
}

TEST(CellTable, CyclesHaveTheKnownLengthsAndPinchedFaces) {
  std::map<int, int> pinched;
  std::set<std::size_t> lengths;
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    unsigned edges = 0;
    for (const CellCycle& cycle : table().cycles(id)) {
      ++pinched[std::popcount(cycle.pinched)];
      lengths.insert(cycle.edges.size());
      for (const std::uint8_t e : cycle.edges) {
        EXPECT_FALSE(edges >> e & 1u) << "edge on two cycles";
        edges |= 1u << e;
      }
    }
    unsigned active = 0;
    for (unsigned e = 0; e < 12; ++e) {
      const auto [low, high] = edge_corners(e);
      if ((table().signs(id) >> low & 1u) != (table().signs(id) >> high & 1u)) active |= 1u << e;
    }
    EXPECT_EQ(edges, active);
    EXPECT_EQ(table().config(id).active_edges, active);
  }
  EXPECT_EQ(pinched, (std::map<int, int>{{0, 670}, {1, 168}, {2, 60}, {3, 96}, {6, 32}}));
  EXPECT_EQ(lengths, (std::set<std::size_t>{3, 4, 5, 6, 7, 8, 9, 12}));
}

TEST(CellTable, DualVerticesHaveTheKnownHistogram) {
  std::map<int, int> vertices;
  std::map<std::size_t, std::set<int>> chords_of_twelve_cycles;
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    ++vertices[table().config(id).vertices];
    EXPECT_EQ(table().config(id).vertices, table().cycles(id).size() + table().chords(id).size());
    if (table().cycles(id).size() == 1 && table().cycles(id)[0].edges.size() == 12) {
      chords_of_twelve_cycles[table().chords(id).size()].insert(id);
      EXPECT_EQ(table().cycles(id)[0].pinched, 0b111111);
    }
  }
  EXPECT_EQ(vertices, (std::map<int, int>{{0, 2}, {1, 126}, {2, 360}, {3, 128}, {4, 40}}));
  ASSERT_EQ(chords_of_twelve_cycles.size(), 2u);
  EXPECT_EQ(chords_of_twelve_cycles[1].size(), 24u);
  EXPECT_EQ(chords_of_twelve_cycles[2].size(), 8u);
  std::set<int> classes;
  for (const int id : chords_of_twelve_cycles[2]) classes.insert(class_of(id));
  EXPECT_EQ(classes.size(), 1u);
}

TEST(CellTable, InversionReversesTheCycles) {
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    const unsigned bits = static_cast<unsigned>(std::popcount(table().ambiguous_faces(table().signs(id))));
    const int inverse = table().id(255u - table().signs(id), ((1u << bits) - 1u) ^ table().resolution(id));
    const auto cycles = table().cycles(id), reversed = table().cycles(inverse);
    ASSERT_EQ(cycles.size(), reversed.size());
    for (std::size_t c = 0; c < cycles.size(); ++c) {
      std::vector<std::uint8_t> back = reversed[c].edges;  // starts at the same, smallest edge
      std::reverse(back.begin() + 1, back.end());
      EXPECT_EQ(cycles[c].edges, back);
    }
    EXPECT_TRUE(std::ranges::equal(table().chords(id), table().chords(inverse)));
  }
}

/// The chords of the image are the image of the chords.
bool split_follows(int id, const CellSymmetry& g) {
  std::vector<CellChord> image;
  for (const CellChord& chord : table().chords(id)) {
    const auto [a, b] = std::minmax(g.edge[chord.a], g.edge[chord.b]);
    image.push_back({a, b});
  }
  std::ranges::sort(image);
  return std::ranges::equal(image, table().chords(transform_config(table(), id, g)));
}

TEST(CellTable, SplitsFollowEverySymmetryWhereChordsCan) {
  std::set<int> turned_classes, mirrored_classes;
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    for (const CellSymmetry& g : cell_symmetries()) {
      if (split_follows(id, g)) continue;
      turned_classes.insert(class_of(id));
      if (g.axes_fixed) mirrored_classes.insert(class_of(id));
    }
  }
  // By trial of all smallest chord sets: five curves have a symmetry of order 2, 8 or 12 that none of their chord sets
  // has, and for one of them, the eight edges around two opposite pinched faces, it is a mirror.
  EXPECT_EQ(turned_classes.size(), 5u);
  ASSERT_EQ(mirrored_classes.size(), 1u);
  EXPECT_EQ(table().cycles(*mirrored_classes.begin())[0].edges.size(), 8u);
  // Everywhere the exchange of inside and outside keeps the split: InversionReversesTheCycles.
}

// What the proof of docs/manifold.md needs of every configuration.
TEST(CellTable, NoPieceHoldsBothSegmentsOfAFace) {
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    const CellConfig& config = table().config(id);
    int incidences = 0;
    for (unsigned p = 0; p < 4; ++p) {
      const unsigned edges = config.piece_edges[p];
      EXPECT_EQ(edges != 0, p < config.vertices);
      EXPECT_TRUE(edges == 0 || std::popcount(edges) >= 3) << "a piece of two crossings folds onto itself";
      incidences += std::popcount(edges);
    }
    EXPECT_EQ(incidences, config.incidences);
    std::map<std::pair<unsigned, unsigned>, int> segments;  // (face, piece)
    std::set<std::pair<unsigned, unsigned>> chord_edges;    // (piece, piece)
    unsigned doubled = 0;
    for (unsigned e = 0; e < 12; ++e) {
      if (!(config.active_edges >> e & 1u)) continue;
      const CellCorner& corner = config.corners[e];
      EXPECT_TRUE(config.piece_edges[corner.first] >> e & 1u);
      EXPECT_TRUE(config.piece_edges[corner.second] >> e & 1u);
      int pieces_here = 0;
      for (const unsigned edges : config.piece_edges) pieces_here += edges >> e & 1u;
      EXPECT_EQ(pieces_here, corner.first == corner.second ? 1 : 2);
      doubled += corner.first != corner.second;
      if (corner.first != corner.second) chord_edges.insert(std::minmax<unsigned>(corner.first, corner.second));
    }
    EXPECT_EQ(doubled, 2 * table().chords(id).size()) << "a crossing at two chords";
    EXPECT_EQ(chord_edges.size(), table().chords(id).size()) << "two chords between the same two pieces";
    for (const CellCycle& cycle : table().cycles(id)) {
      const std::size_t n = cycle.edges.size();
      for (std::size_t s = 0; s < n; ++s) {
        // The piece of a segment is the one that both its ends share.
        const unsigned from = 1u << cycle.edges[s], to = 1u << cycle.edges[(s + 1) % n];
        for (unsigned p = 0; p < config.vertices; ++p) {
          const unsigned edges = config.piece_edges[p];
          if ((edges & from) && (edges & to)) ++segments[{cycle.faces[s], p}];
        }
      }
    }
    for (const auto& [key, count] : segments) EXPECT_EQ(count, 1) << "config " << id << " face " << key.first;
  }
}

}  // namespace
}  // namespace dubsar
