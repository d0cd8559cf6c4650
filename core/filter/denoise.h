#pragma once
// Edge-preserving denoising (paper section 3.1): median, Gauss, bilateral and joint bilateral filters.

#include <cstdint>
#include <memory>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/text/enum_names.h"
#include "core/filter/histogram.h"
#include "core/volume/brick_mask.h"
#include "core/volume/grid_store.h"
#include "core/volume/slab_source.h"
#include "core/volume/volume.h"

namespace dubsar {

enum class DenoiseMethod {
  kMedian,          ///< of the window
  kGauss,           ///< binomial weights
  kBilateral,       ///< weights from the differences in the image itself
  kJointBilateral,  ///< weights from the differences in the image after Gauss 3x3x3
};

inline constexpr EnumName<DenoiseMethod> kDenoiseMethods[] = {
    {DenoiseMethod::kMedian, "median"},
    {DenoiseMethod::kGauss, "gauss"},
    {DenoiseMethod::kBilateral, "bilateral"},
    {DenoiseMethod::kJointBilateral, "joint_bilateral", "joint"},
};
static_assert(names_all(kDenoiseMethods, static_cast<std::size_t>(DenoiseMethod::kJointBilateral) + 1));

/// Whether the method weighs neighbours by their differences, and so needs the noise.
constexpr bool needs_sigma(DenoiseMethod method) {
  return method == DenoiseMethod::kBilateral || method == DenoiseMethod::kJointBilateral;
}

/// How much a neighbour with difference d counts, next to the spatial (binomial) weight.
enum class RangeWeight {
  kTukey,  ///< (1 - (d / s')^2)^2 for d < s', else 0; s' = 2.1262 sigma gives e^-1/2 at sigma (paper, figure 5)
  kGauss,  ///< exp(-d^2 / (2 sigma^2))
};

inline constexpr EnumName<RangeWeight> kRangeWeights[] = {{RangeWeight::kTukey, "tukey"},
                                                          {RangeWeight::kGauss, "gauss"}};
static_assert(names_all(kRangeWeights, static_cast<std::size_t>(RangeWeight::kGauss) + 1));

/// s' / sigma = 1 / sqrt(1 - exp(-1/4)): both weights are e^-1/2 at sigma (paper section 3.1).
inline constexpr double kTukeyScale = 2.1262200413381014;

struct DenoiseOptions {
  DenoiseMethod method = DenoiseMethod::kJointBilateral;
  RangeWeight range = RangeWeight::kTukey;
  int window = 3;      ///< 3, 5 or 7 voxels per axis
  int iterations = 2;  ///< 0 passes the source through
  double sigma = 0.0;  ///< standard deviation of the noise, in grey values; the bilateral filters need it (> 0)
};

/// kUsage, with the reason, for options that make no sense.
Result<void> check(const DenoiseOptions& options);

/// The denoised source: a chain of one filter per iteration. Borrows `source`, which must outlive it.
///
/// Edges are clamped. Finite values stay finite; voxels whose neighbourhood sums beyond 3e38 are left as they are.
/// The output depends on neither slab height, order nor threads, to the bit. Memory: per iteration about 2 window + 2
/// slices and a few megabytes. Cost per voxel and iteration: 26 taps of 6 operations for the 3x3x3 bilateral filters.
/// Errors: those of check() and of the source.
///
/// With a mask in `wanted` only its points are made, the same to the bit, and whatever stands elsewhere in a slab is
/// nothing; the source is asked for slices that are seen from there. The cost is that of the points, besides copies.
Result<std::unique_ptr<SlabSource>> make_denoised(SlabSource& source, const DenoiseOptions& options,
                                                  const Wanted& wanted = {});

/// How far, along each axis, all iterations look from a voxel.
std::int64_t reach_of(const DenoiseOptions& options) noexcept;

/// The same result written over the grid itself, in memory or on the disk; extra memory is that of the slices above.
/// Advances `progress` by voxels (iterations * count in all). `counts`, if given, gets the values of the result.
/// kCancelled leaves the grid half filtered.
Result<void> denoise_in_place(GridStore& grid, const DenoiseOptions& options, Progress& progress,
                              ParallelCounts* counts = nullptr);
Result<void> denoise_in_place(Volume<float>& volume, const DenoiseOptions& options, Progress& progress);

}  // namespace dubsar
