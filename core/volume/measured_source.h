#pragma once
// A slab source whose voxels are all measurements, or count as air.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/volume/blank_slices.h"
#include "core/volume/slab_source.h"
#include "core/volume/unmeasured.h"

namespace dubsar {

/// Replaces voxels that are no measurement (unmeasured.h) by its fill value, which depends on the volume alone, not on
/// the order or the height of the slabs read. Up to three slices of nothing else (one value, or NaN) between others are
/// bridged: each voxel goes straight from one side to the other. So it is where a value is given or found to be no
/// measurement, or hardly occurs at the border of the slices beside it: the air of a scan without noise is none.
class MeasuredSource final : public SlabSource {
 public:
  struct Options {
    IgnoredValues ignored;
    std::optional<Unmeasured> known;  ///< of an earlier look at the same volume: it is not looked for again
    std::optional<float> fill;        ///< instead of the one that is found
    bool may_have_nonfinite = true;
  };
  MeasuredSource(std::unique_ptr<SlabSource> source, Options options);

  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  std::int64_t preferred_height() const noexcept override { return source_->preferred_height(); }
  /// kBadData once more than 1 % of all voxels of the volume were found to be NaN or Inf between measurements.
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

  /// Looks for it the first time, before anything is read. Errors of find_unmeasured().
  Result<Unmeasured> unmeasured();

  /// Replaced so far; a slice that is read again counts once.
  struct Counts {
    std::int64_t outside = 0;    ///< of the field of view, or of a value to be ignored
    std::int64_t nonfinite = 0;  ///< NaN and Inf, wherever they are
    std::int64_t all() const noexcept { return outside + nonfinite; }
  };
  const Counts& counts() const noexcept { return counts_; }
  /// Bridged slices of those read so far, of the grid read, ascending.
  std::vector<std::int64_t> bridged() const;

 private:
  Counts fill_slice(std::span<float> slice, std::int64_t& between) const;

  std::unique_ptr<SlabSource> source_;
  Options options_;
  std::vector<std::uint8_t> counted_;  ///< per slice: 1 once its voxels are in counts_, 2 where it was bridged
  Counts counts_;
  std::int64_t between_ = 0;  ///< NaN and Inf with measurements on both sides in their row
};

}  // namespace dubsar
