#pragma once
// The surface at the scan's own resolution, from the bricks around the one that was found at half of it: only they are
// filtered and kept.

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/filter/denoise.h"
#include "core/refine/brick_values.h"
#include "core/refine/near_surface.h"

namespace dubsar {

/// Passes over the scan one after the other, each with its own noise, and sharpening at the end (0: none), first the
/// wide one, beside surfaces at `level` (sharpen.h).
struct BandFilters {
  std::vector<DenoiseOptions> passes;
  float sharpen = 0.0f, sharpen_wide = 0.0f;
  float level = 0.0f;
};

/// The scan behind these filters, at the points that are wanted; nothing elsewhere (denoise.h). Borrows scan and mask.
class FilteredScan final : public SlabSource {
 public:
  static Result<FilteredScan> make(SlabSource& scan, const BandFilters& filters, const Wanted& wanted);
  Dims dims() const noexcept override { return last_->dims(); }
  const GridFrame& frame() const noexcept override { return last_->frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    return last_->read(z_begin, z_end, out);
  }

 private:
  explicit FilteredScan(SlabSource& scan) : last_(&scan) {}
  std::vector<std::unique_ptr<SlabSource>> filters_;
  SlabSource* last_;
};

/// The same with constants instead of nothing: for those who look at all of it.
class BandSource final : public SlabSource {
 public:
  /// `wanted` must have a mask, that of `surface`.
  static Result<BandSource> make(SlabSource& scan, const BandFilters& filters, const NearSurface& surface,
                                 std::int64_t reach, const OutsideValues& outside);
  Dims dims() const noexcept override { return filtered_.dims(); }
  const GridFrame& frame() const noexcept override { return filtered_.frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  BandSource(FilteredScan filtered, const NearSurface& surface, std::int64_t reach, const OutsideValues& outside)
      : filtered_(std::move(filtered)), surface_(&surface), reach_(reach), outside_(outside) {}
  FilteredScan filtered_;
  const NearSurface* surface_;
  std::int64_t reach_;
  OutsideValues outside_;
};

struct BandReport {
  std::int64_t bricks = 0;  ///< that were filtered and kept
  double share = 0.0;       ///< of all
  std::int64_t added = 0;   ///< since the surface left those that were marked at first
  std::int64_t cut = 0;     ///< at which it still does after all rounds, and ends there
};

struct SurfaceBand {
  BrickValues values;
  BandReport report;
};

/// Filters and keeps the bricks near the surface, and then, as often as needed, those into which surface runs from
/// them: the surface of the result at `threshold` is that of the whole scan behind these filters, without pieces that
/// are nowhere near what half the resolution shows. One pass over the scan for each round, of what there are slices of
/// in it. Memory: 2 KiB a brick, a few slices. The same for any number of threads. Errors: kTryAgain, kCancelled, those
/// of the scan and of check(DenoiseOptions).
Result<SurfaceBand> read_band(SlabSource& scan, NearSurface surface, const BandFilters& filters, float threshold,
                              const OutsideValues& outside, Progress& progress);

}  // namespace dubsar
