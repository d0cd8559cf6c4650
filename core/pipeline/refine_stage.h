#pragma once
// The stages that find the surface at the scan's own resolution, once the same scan is known at half of it: a sample of
// it says how it is filtered, and only the bricks near the surface are.

#include "core/pipeline/volume_stages.h"
#include "core/refine/surface_band.h"

namespace dubsar {

struct RefineOptions {
  DenoiseOptions denoise;  ///< sigma 0: estimated anew before each iteration, from the sample
  EstimateOptions estimate;
  std::optional<float> threshold;
  SampleOptions sample;
  std::optional<EdgeSpread> blur;  ///< of the scan
};

struct RefinedSurface {
  SampledSurface sampled;
  Threshold threshold;
  std::vector<FilterStep> steps;  ///< of the sample
  BandReport band;
};

/// Three records: "sample" (some slices, filtered in whole), "band", "extract". `half` is the scan after 2:1 and
/// filters, `half_noise` what they left of the noise there; it is released as soon as the bricks are marked. Memory: 2
/// KiB a brick near the surface, the sample (up to 0.6 GB), a few slices. Errors: those of the stages above;
/// kTryAgain when there is no room.
Result<RefinedSurface> refine(SlabSource& scan, GridStore& half, double half_noise, const RefineOptions& options,
                              const Budget& budget, StageRun run);

}  // namespace dubsar
