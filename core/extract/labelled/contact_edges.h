#pragma once
// The grid edges between the tablet's clay and the envelope's, numbered: each is an x-quad of the contact.

#include <cstdint>
#include <vector>

#include "core/extract/labelled/point_labels.h"

namespace dubsar {

/// From a point of the grid, or of the layer of air around it, one step along an axis.
struct GridEdge {
  std::int32_t x = 0, y = 0, z = 0, axis = 0;
  friend bool operator==(const GridEdge&, const GridEdge&) = default;
};

class ContactEdges {
 public:
  /// Cost: a pass over the bits, all threads.
  explicit ContactEdges(const PointLabels& labels);

  /// From clay of one to clay of the other, in the canonical order of surface_samples.h: rows (z, y), in each axis x,
  /// y, z, then x.
  const std::vector<GridEdge>& all() const noexcept { return edges_; }
  /// Number of one of them.
  std::uint32_t number(std::int64_t axis, std::int64_t x, std::int64_t y, std::int64_t z) const noexcept;

 private:
  Dims dims_;
  std::vector<GridEdge> edges_;
  std::vector<std::uint32_t> starts_;  ///< of rows, and behind the last
};

}  // namespace dubsar
