#pragma once
// From an active edge of the grid extended by the virtual layer to the number of its x-quad, without a stored
// adjacency: row starts and population counts.

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/extract/surface_samples.h"

namespace dubsar {

/// Numbers of the first active edge and ambiguous face of each axis in one grid row.
struct RowStarts {
  std::array<std::uint32_t, 3> edges{};
  std::array<std::uint32_t, 3> faces{};
};

class EdgeIndex {
 public:
  /// Cost: two passes over the bits. kTryAgain beyond 2^32 - 2 edges. Keeps a reference to `samples`.
  static Result<EdgeIndex> create(const SurfaceSamples& samples);

  /// Active edges and ambiguous faces inside the grid.
  const SampleCounts& counts() const noexcept { return counts_; }
  std::int64_t virtual_edges() const noexcept { return virtual_edges_; }
  /// Of a row inside the grid.
  const RowStarts& starts(std::int64_t y, std::int64_t z) const noexcept {
    return starts_[static_cast<std::size_t>(z * dims_.y + y)];
  }
  /// Numbers that the active edges of a row of the extended grid begin with: along x without those at its ends, along y
  /// and z without those that start at x = -1, which are never active. 0 where all points are outside the grid.
  std::uint32_t first_along(int axis, std::int64_t y, std::int64_t z) const noexcept;
  /// Number of the virtual edge along x at the low or high end of a row; 0 for rows outside the grid.
  std::uint32_t end_of_row(std::int64_t y, std::int64_t z, bool high) const noexcept;
  /// Number of the x-quad of the active edge that starts at a point of the extended grid (-1 .. n - 1).
  std::uint32_t quad_of(int axis, std::int64_t x, std::int64_t y, std::int64_t z) const noexcept;
  bool is_virtual(int axis, std::int64_t x, std::int64_t y, std::int64_t z) const noexcept;

 private:
  explicit EdgeIndex(const SurfaceSamples& samples) : samples_(&samples), dims_(samples.dims) {}
  bool has_row(std::int64_t y, std::int64_t z) const noexcept { return y >= 0 && z >= 0 && y < dims_.y && z < dims_.z; }
  std::uint32_t virtual_start(std::int64_t y, std::int64_t z) const noexcept {
    return virtual_starts_[static_cast<std::size_t>((z + 1) * (dims_.y + 1) + y + 1)];
  }
  std::array<std::uint32_t, 3> count_virtual(std::int64_t y, std::int64_t z) const noexcept;
  const std::uint64_t* virtual_row(int axis, std::int64_t y, std::int64_t z) const noexcept;

  const SurfaceSamples* samples_;
  Dims dims_;
  SampleCounts counts_;
  std::int64_t virtual_edges_ = 0;
  std::vector<RowStarts> starts_;
  std::vector<std::uint32_t> virtual_starts_;  ///< per extended row, (y + 1) + (z + 1) (ny + 1)
};

}  // namespace dubsar
