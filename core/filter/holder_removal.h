#pragma once
// A scan without what its object stands in.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/filter/holder_search.h"
#include "core/volume/slab_source.h"

namespace dubsar {

inline constexpr std::int64_t kHolderCell = 4;  ///< voxels of the scan along each axis

/// Where a holder is, in cells of the scan.
struct HolderMask {
  Dims cells;
  std::vector<std::uint8_t> inside;  ///< 1: the holder, or one of two cells beside it
  float air = 0.0f, holder = 0.0f, clay = 0.0f;
  std::optional<float> left_out;  ///< value of voxels that are no measurement, which stay as they are

  /// Share of the holder at a row of a grid with `steps` grid steps a cell, trilinear between the middles of cells.
  /// False, and nothing written: it is 0 in all of the row.
  bool row(std::int64_t y, std::int64_t z, std::int64_t steps, std::span<float> out) const;
  /// Whether it reaches slices of that grid.
  bool reaches(std::int64_t z_begin, std::int64_t z_end, std::int64_t steps) const;
};

/// Cells near those that were found whose level is the holder's, most of those beside them being so, too: the edges of
/// clay in air, which pass that level, are thinner. `half`: the scan after 2:1. Errors: those of the source,
/// kCancelled.
Result<HolderMask> make_holder_mask(SlabSource& half, const FoundHolder& found, Progress& progress);

/// A source in which the holder has the level of air. Where clay touches it, the surface is half way between both: what
/// a Gauss of a voxel leaves is stretched until the holder is at the level of air (all that is darker, too), and noise
/// is added as it was, so that a lower contrast costs resolution, not noise. Where both air and clay lie within two
/// voxels, and away from the holder, every bit is that of the source. Borrows the source, whose grid has `steps` steps
/// a cell of the mask: 4, or 2 after 2:1. Memory: the slab that is asked for, two and a quarter times with four slices
/// at either end, and the mask.
class HolderlessSource final : public SlabSource {
 public:
  HolderlessSource(SlabSource& source, HolderMask mask, std::int64_t steps)
      : source_(&source), mask_(std::move(mask)), steps_(steps) {}
  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  std::int64_t preferred_height() const noexcept override { return source_->preferred_height(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  SlabSource* source_;
  HolderMask mask_;
  std::int64_t steps_;
};

}  // namespace dubsar
