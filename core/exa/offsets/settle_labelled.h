#pragma once
// A labelled mesh in a model such that a file stores it compactly: its vertices follow from the samples, but for those
// that escape inside their cells.

#include <cstdint>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/parts/surface_model.h"
#include "core/relief/curvature/curvature.h"

namespace dubsar {

struct LabelledSettling {
  std::int64_t escaped = 0;   ///< vertices of cells with clay of both
  std::int64_t touching = 0;  ///< cells where polygons touched
  std::int64_t left = 0;      ///< of these those where they do all the same
};

/// Puts the mesh that model.labelled tells of (labelled_surface.h) in place of the model's own, the vertices of its
/// mixed cells at the nearest place inside their cells that a file can hold, and where polygons would touch elsewhere
/// in the cell; all others lie at such places already (settle_for_exa()). Draws it and measures the partitions.
/// Normals, curvatures and shape classes, where the model has any, are then those of recomputed_normals() and
/// principal_curvatures() of what lies at the air, `exact_normals`: those that it had. Errors of build_labelled_mesh(),
/// kCancelled. Deterministic for any thread count.
Result<LabelledSettling> settle_labelled(SurfaceModel& model, LabelledMesh labelled, CurvatureMethod curvature,
                                         bool exact_normals, Progress& progress);

}  // namespace dubsar
