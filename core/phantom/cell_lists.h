#pragma once
// Which small features can matter near a place: lists per cell of 16 voxels.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/volume/volume.h"

namespace dubsar::phantom {

inline constexpr int kCellEdge = 16;

struct Ball {
  glm::dvec3 centre;  ///< input voxels
  double radius;      ///< everything the feature can influence lies inside
};

class CellLists {
 public:
  CellLists() = default;
  /// Ids of the balls that meet each cell, rising. Cost: balls times cells touched, twice; memory 4 B a cell + hits.
  CellLists(Dims dims, std::span<const Ball> balls);
  std::span<const std::uint32_t> operator[](std::int64_t cell) const noexcept {
    if (first_.empty()) return {};
    return {ids_.data() + first_[static_cast<std::size_t>(cell)],
            ids_.data() + first_[static_cast<std::size_t>(cell) + 1]};
  }

 private:
  std::vector<std::uint32_t> first_, ids_;
};

/// Cells cover the grid and one cell around it; places farther out use the nearest cell.
struct CellGrid {
  explicit CellGrid(Dims dims = {})
      : nx(dims.x / kCellEdge + 3), ny(dims.y / kCellEdge + 3), nz(dims.z / kCellEdge + 3) {}
  std::int64_t nx, ny, nz;
  std::int64_t count() const noexcept { return nx * ny * nz; }
  std::int64_t index(double x, double y, double z) const noexcept;
};

}  // namespace dubsar::phantom
