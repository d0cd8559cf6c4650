#pragma once
// A slab source without NaN and Inf: they are counted and replaced by air.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/volume/slab_source.h"

namespace dubsar {

/// Replaces NaN and Inf. Air is `fill`, or the 5 % quantile of the finite values of nine slices spread evenly over the
/// volume: it depends on the volume alone, not on the order or the height of the slabs read. (The quantile stands for
/// air because a scan shows more air than that around the object, and one noisy or dead voxel does not move it.)
class FiniteSource final : public SlabSource {
 public:
  FiniteSource(std::unique_ptr<SlabSource> source, std::optional<float> fill);

  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  std::int64_t preferred_height() const noexcept override { return source_->preferred_height(); }
  /// kBadData once more than 1 % of all voxels of the volume were found not to be finite.
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

  /// Replaced so far; a slice that is read again counts once.
  std::int64_t count() const noexcept { return count_; }
  float fill() const noexcept { return fill_.value_or(0.0F); }

 private:
  Result<float> estimate_air();

  std::unique_ptr<SlabSource> source_;
  std::optional<float> fill_;
  std::vector<std::uint8_t> counted_;  ///< per slice: 1 once its NaN and Inf are in count_
  std::int64_t count_ = 0;
};

}  // namespace dubsar
