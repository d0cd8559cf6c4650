#pragma once
// Ambient occlusion of a surface model: each part is lit as if it lay alone in the hand.

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/parts/surface_model.h"
#include "core/relief/occlusion/occlusion.h"

namespace dubsar {

/// Fills model.attributes.ao, one value a dual vertex. A vertex on the border of two parts takes the brighter of its
/// two values. Errors: those of ambient_occlusion().
Result<void> occlusion_of_model(SurfaceModel& model, const OcclusionOptions& options, Progress& progress);

}  // namespace dubsar
