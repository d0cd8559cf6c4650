#pragma once
// A part of a lattice as a graph between a source and a sink: what is left of each capacity, and the trees that a
// search (lattice_search.h) grows in it. Points lie in bricks and know their neighbours by their place.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/base/system/large_pages.h"
#include "core/contact/cut/lattice_bricks.h"

namespace dubsar {

struct LatticeGraph {
  static constexpr std::uint32_t kWays = LatticeBricks::kWays, kPoints = LatticeBricks::kPoints;
  static constexpr std::uint32_t kTies = 16, kNoArc = 0xffffffffu;
  static constexpr std::uint8_t kTerminal = 6, kOrphan = 7, kNoParent = 8, kByTie = 9;  ///< behind the ways to a parent
  static constexpr std::uint8_t kActive = 1, kTied = 2;                                 ///< flags

  struct Point {
    std::int32_t terminal = 0;  ///< > 0: from the source, < 0: to the sink
    std::uint32_t time = 0;     ///< when the label was right
    std::uint32_t up = 0;       ///< the parent
    /// On a tree: steps from the source, minus those to the sink, at some time; else 0. Before: the height.
    std::int16_t label = 0;
    std::uint8_t parent = kNoParent;  ///< a way, or one of the above
    std::uint8_t flags = 0;
    std::array<std::uint16_t, kWays> residual{};
  };
  static_assert(sizeof(Point) == 28);
  /// An arc is a way of its point, or kTies + the index of a tie.
  struct Tie {
    std::uint32_t head, next;  ///< next of the same point; the sister is the other of the pair
    std::int32_t residual;
  };
  struct Ties {
    std::uint32_t first, parent;  ///< parent: the tie to it where the point has it by one
  };

  const LatticeBricks& bricks;
  LargeArray<Point> points;
  std::vector<Tie> ties;
  std::unordered_map<std::uint32_t, Ties> tied;  ///< points that have some

  static constexpr std::uint32_t sister(std::uint32_t arc) noexcept { return arc ^ 1; }
  std::uint32_t head(std::uint32_t p, std::uint32_t arc) const {
    return arc < kWays ? bricks.beside(p, arc) : ties[arc - kTies].head;
  }
  std::int32_t residual(std::uint32_t p, std::uint32_t arc) const {
    return arc < kWays ? points[p].residual[arc] : ties[arc - kTies].residual;
  }
  /// Returns what is left.
  std::int32_t add(std::uint32_t p, std::uint32_t arc, std::int32_t flow) {
    if (arc >= kWays) return ties[arc - kTies].residual += flow;
    std::uint16_t& left = points[p].residual[arc];
    return left = static_cast<std::uint16_t>(left + flow);
  }
  /// The arc to the parent, or one of the above.
  std::uint32_t parent(std::uint32_t p) const {
    const std::uint8_t parent = points[p].parent;
    return parent == kByTie ? kTies + tied.at(p).parent : parent;
  }
  void set_parent(std::uint32_t p, std::uint32_t arc, std::uint32_t up) {
    points[p].up = up;
    points[p].parent = arc < kWays ? static_cast<std::uint8_t>(arc) : kByTie;
    if (arc >= kWays) tied.at(p).parent = arc - kTies;
  }
};

}  // namespace dubsar
