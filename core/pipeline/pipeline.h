#pragma once
// From a scan to a surface model, unattended: every stage of the paper in its order, parameters estimated unless given.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/exa/exa_file.h"
#include "core/exa/settle.h"
#include "core/filter/denoise.h"
#include "core/filter/estimate.h"
#include "core/mesh/mesh_check.h"
#include "core/parts/holes.h"
#include "core/parts/segment.h"
#include "core/parts/surface_model.h"
#include "core/pipeline/stage_clock.h"
#include "core/relief/curvature.h"
#include "core/relief/occlusion.h"
#include "core/relief/shape_class.h"
#include "core/relief/smooth.h"
#include "core/volume/import.h"

namespace dubsar {

struct PipelineOptions {
  ImportOptions import;
  bool resample = true;          ///< Gauss 3x3x3 and 2:1
  DenoiseOptions denoise;        ///< sigma 0: estimated anew before each iteration
  std::optional<float> sharpen;  ///< amount (sharpen.h); default: 1 where the noise allows it, see volume_stages.cpp
  EstimateOptions estimate;
  std::optional<float> threshold;  ///< isovalue; overrides the estimate
  int offset_bits = 4;             ///< N
  bool closed_boundary = true;
  SmoothOptions smooth;
  CurvatureMethod curvature = CurvatureMethod::kFit;
  SettleOptions settle;  ///< its curvature method is the one above
  SegmentOptions segment;
  bool fill_holes = true;
  bool occlusion = true;
  OcclusionOptions occlusion_options;
};

/// Noise before the first filter and after each one.
struct FilterStep {
  std::string name;  ///< "raw", "gauss 2:1", "joint_bilateral 1", ...
  Estimates estimates;
};

struct PipelineReport {
  VolumeInfo input;
  std::int64_t nonfinite_voxels = 0;
  float nonfinite_fill = 0.0f;
  Dims grid;             ///< processed grid
  float sharpen = 0.0f;  ///< amount that was used
  std::vector<StageRecord> stages;
  std::vector<FilterStep> filters;
  Estimates estimates;  ///< those that the threshold comes from
  float threshold = 0.0f;
  std::string threshold_path;  ///< how it was found
  SmoothStats smooth;
  SettleStats settle;
  SegmentReport segment;            ///< of the segmentation that was believed
  bool enclosure_refused = false;   ///< a body in another was found, but it did not fill its cavity as a tablet would
  std::optional<HoleReport> holes;  ///< when holes were filled
  MeshCheck mesh;                   ///< of all parts together, with their fill patches
  std::int64_t vertices = 0, xquads = 0;
  PartitionTable partitions;
  ExaStats exa;
  std::vector<std::string> warnings;
};

struct PipelineResult {
  SurfaceModel model;
  PipelineReport report;
};

/// Runs all stages; memory for about two volumes of the resampled grid in float, then about 200 bytes a vertex. Cancel
/// leaves nothing behind. Errors: those of the stages; kBadData when there is no surface at the threshold.
Result<PipelineResult> run_pipeline(const PipelineOptions& options, Progress& progress);

/// Writes the model to `path` (as one more stage) and completes the report. An old file stays until the new one is
/// whole.
Result<void> write_product(const std::string& path, PipelineResult& result, Progress& progress);

}  // namespace dubsar
