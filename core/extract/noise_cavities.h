#pragma once
// Cavities in the clay that the noise made: closed surfaces too small for the blur, or too faint for the noise around.

#include <cstdint>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/surface_samples.h"
#include "core/volume/slab_source.h"

namespace dubsar {

struct CavityRule {
  double blur_vox = 0.65;  ///< standard deviation of an edge, grid steps
  /// Closed air of fewer points than a ball of three such deviations across holds was not there: blurred, a ball of
  /// that size just reaches half of the contrast.
  double deviations_across = 3.0;
  /// Of clay around the cavity, in a robust measure: air whose least value is above clay less so many is its noise.
  double noise_deviations = 4.0;
};

struct NoiseCavities {
  std::int64_t cavities = 0;
  std::int64_t points = 0;  ///< of the grid, in them
};

/// Turns them into clay, with their crossings and face decisions. `source`: what was sampled; where cavities of up to
/// 64 points may be noise its slices around them are read once more. Cavities that touch the border of the grid stay.
/// The same for any number of threads. Errors of the source, kCancelled, those of EdgeIndex.
Result<NoiseCavities> fill_noise_cavities(SurfaceSamples& samples, SlabSource& source, const CavityRule& rule,
                                          Progress& progress);

}  // namespace dubsar
