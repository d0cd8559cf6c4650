#pragma once
// The stages that work on the surface: smoothing and curvature, what a file can hold of them, parts, light, check. Each
// is a function of values; a report is made from their results (report.h).

#include <optional>

#include "core/exa/exa_text.h"
#include "core/exa/offsets/settle.h"
#include "core/mesh/mesh_check.h"
#include "core/parts/fill/holes.h"
#include "core/parts/segment.h"
#include "core/parts/surface_model.h"
#include "core/pipeline/stage_clock.h"
#include "core/relief/curvature/curvature.h"
#include "core/relief/occlusion/occlusion.h"
#include "core/relief/smoothing/smooth.h"

namespace dubsar {

/// The x-quads of the samples. kBadData, naming the threshold, when there are none.
Result<QuadMesh> mesh_of_samples(const SurfaceSamples& samples, float threshold, StageRun run);

struct SmoothedMesh {
  QuadMesh mesh;
  VertexAttributes attributes;  ///< normals, curvatures, shape classes
  SmoothStats stats;
};
Result<SmoothedMesh> smooth_and_measure(QuadMesh mesh, const SmoothOptions& options, CurvatureMethod curvature,
                                        StageRun run);

struct SettledModel {
  SurfaceModel model;
  SettleStats stats;
};
/// From here on the model is what a file will hold.
Result<SettledModel> settle(SurfaceModel model, const SettleOptions& options, StageRun run);

struct SeparatedModel {
  SurfaceModel model;
  SegmentReport segment;
  std::optional<HoleReport> holes;  ///< when they were filled
};
Result<SeparatedModel> separate(SurfaceModel model, const SegmentOptions& options, bool fill, StageRun run);

/// The light of each dual vertex, from the triangles of its own body.
Result<SurfaceModel> shade(SurfaceModel model, const OcclusionOptions& options, StageRun run);

struct CheckedProduct {
  TriMesh mesh;  ///< positions, and how places are known
  MeshCheck check;
};
/// All parts together, with their fill patches.
Result<CheckedProduct> check_product(const SurfaceModel& model, StageRun run);

}  // namespace dubsar
