#pragma once
// From a scan to a surface model, unattended: every stage of the paper in its order, parameters estimated unless given.

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/trace.h"
#include "core/pipeline/rays_stage.h"
#include "core/pipeline/report.h"
#include "core/pipeline/surface_stages.h"
#include "core/pipeline/volume_stages.h"

namespace dubsar {

struct PipelineOptions {
  ImportOptions import;
  Detail detail = Detail::kAuto;
  Artefacts artefacts = Artefacts::kAuto;
  DenoiseOptions denoise;  ///< sigma 0: estimated anew before each iteration
  EstimateOptions estimate;
  std::optional<float> threshold;  ///< isovalue; overrides the estimate
  SampleOptions sample;
  SmoothOptions smooth;
  CurvatureMethod curvature = CurvatureMethod::kFit;
  SettleOptions settle;  ///< its curvature method is the one above
  SegmentOptions segment;
  bool fill_holes = true;
  /// By which the contact is traced in the scan, with filled holes only; none: it is as the smooth patches are.
  std::optional<ContactRules> contact = ContactRules{};
  std::optional<OcclusionOptions> occlusion = OcclusionOptions{};  ///< none: no ambient light
};

struct PipelineResult {
  SurfaceModel model;
  PipelineReport report;
  TriMesh mesh;  ///< the model as it was checked: all parts with their patches; positions, and how places are known
};

/// Runs all stages; memory for about one volume of the resampled grid in float, then about 200 bytes a vertex. Cancel
/// leaves nothing behind. Errors: those of the stages.
Result<PipelineResult> run_pipeline(const PipelineOptions& options, Progress& progress);

/// Writes the model to `path` (as one more stage) and completes the report. An old file stays until the new one is
/// whole.
Result<void> write_product(const std::string& path, PipelineResult& result, Progress& progress);

}  // namespace dubsar
