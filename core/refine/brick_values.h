#pragma once
// A large grid of which only some bricks are kept: values there, and elsewhere one of two constants.

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/volume/brick_mask.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// What a point counts as that is not kept.
struct OutsideValues {
  float below = 0.0f, above = 0.0f;
};

class BrickValues final : public SlabSource {
 public:
  /// `inside`: bricks that count as `above` while they are not kept, the others as `below`. Memory: 4 bytes a brick,
  /// and 2 KiB for each that is kept.
  BrickValues(BrickMask inside, GridFrame frame, const OutsideValues& outside);
  Dims dims() const noexcept override { return inside_.dims(); }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

  /// Keeps `bricks` of a source of these dims, none of which is kept yet; it is asked for the slices in which there are
  /// some, in rising order. Advances `progress` by slices. kTryAgain: no room; kCancelled; errors of the source.
  Result<void> keep(const BrickMask& bricks, SlabSource& source, Progress& progress);
  std::int64_t kept() const noexcept { return kept_; }

  /// Bricks that are not kept, next to one of `bricks` (which are) that has points on the other side of the threshold
  /// at their common face: surface would end there.
  BrickMask crossed(const BrickMask& bricks, float threshold) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  const float* values_of(std::int64_t bx, std::int64_t by, std::int64_t bz) const noexcept;
  bool crosses(const float* brick, int axis, bool last, const Dims& points, bool inside, float threshold) const;

  BrickMask inside_;
  GridFrame frame_;
  OutsideValues outside_;
  std::vector<std::uint32_t> place_;  ///< of each brick
  std::vector<Buffer<float>> blocks_;
  std::int64_t kept_ = 0;
};

}  // namespace dubsar
