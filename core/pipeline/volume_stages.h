#pragma once
// The stages that work on voxels: import, resampling, denoising, estimates, sampling of the isosurface.

#include "core/pipeline/pipeline.h"

namespace dubsar {

/// From the file to the samples of the surface; fills input, grid, filters, estimates and threshold of the report.
Result<SurfaceSamples> run_volume_stages(const PipelineOptions& options, PipelineReport& report, GridFrame& frame,
                                         StageClock& clock, Progress& progress);

}  // namespace dubsar
