#pragma once
// The polygons around a vertex in fans: those that hang together through edges at the vertex. A vertex with more than
// one fan is where a surface touches itself.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/numbers/disjoint_sets.h"

namespace dubsar {

/// Fans around one vertex at a time; keeps its memory from one to the next.
class Fans {
 public:
  void clear() { corners_.clear(); }
  /// A polygon's corner at the vertex: the vertices that follow and precede it in the polygon.
  void add(std::uint32_t next, std::uint32_t previous) { corners_.push_back({next, previous}); }

  /// Groups the corners: two are in one fan when one's next is the other's previous. O(n log n) for any input. Returns
  /// the number of fans, which are numbered by their first corners.
  std::uint32_t find();
  /// The fan of each corner, in the order of add().
  std::span<const std::uint32_t> of_corner() const noexcept { return fan_; }

 private:
  struct Corner {
    std::uint32_t next, previous;
  };
  bool is_one() const;

  std::vector<Corner> corners_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> starts_;  ///< next, corner; sorted
  std::vector<bool> met_;                                        ///< of each start: a corner ends where it starts
  DisjointSets sets_;
  std::vector<std::uint32_t> fan_;
};

}  // namespace dubsar
