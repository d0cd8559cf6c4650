#pragma once
// A scan as cells, and the regions of it that have one level each: what a person sees at once in a small picture of it.

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// Means of cells of a scan. The cells lie in its middle; what does not fill a cell is left out at all ends alike.
struct CellMeans {
  Dims dims;
  std::int64_t cell = 1;                 ///< grid steps of the source along each axis
  std::array<std::int64_t, 3> origin{};  ///< of the first cell, grid steps
  std::vector<float> values;
  double noise = 0.0;         ///< of a cell: standard deviation, from differences of neighbours; 0: there is none
  double source_noise = 0.0;  ///< of a value of the source, the same from every other one of some rows

  std::int64_t index(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    return (z * dims.y + y) * dims.x + x;
  }
};

/// Cells of at least `least_cell` grid steps, at most 96 along an axis. Up to `slices` of each layer are read. Errors:
/// those of the source, kCancelled.
Result<CellMeans> read_cells(SlabSource& source, std::int64_t least_cell, std::int64_t slices, Progress& progress);

/// Cells twice as wide along each axis.
CellMeans coarser(const CellMeans& grid);

/// Cells of one level that hang together.
struct FlatRegion {
  double level = 0.0;      ///< mean
  double spread = 0.0;     ///< standard deviation of means of 27 cells
  std::int64_t cells = 0;  ///< and their neighbours
  bool at_border = false;  ///< of the cells
};

struct FlatRegions {
  std::vector<FlatRegion> regions;    ///< the largest first
  std::vector<std::int32_t> of_cell;  ///< of each cell; -1: none
};

/// A place is flat where 27 cells around it differ by no more than noise, or by `least_spread` (standard deviation),
/// and it hangs together with those beside it whose mean is the same but for noise: slow changes, as scatter and
/// hardening make them, stay in one region, edges end it. Regions of fewer than `least_share` of all cells are left
/// out.
FlatRegions find_flat_regions(const CellMeans& grid, double least_spread, double least_share);

}  // namespace dubsar
