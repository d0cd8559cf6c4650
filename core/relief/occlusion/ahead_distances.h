#pragma once
// How far rays may go from where no surface is.

#include "core/base/progress.h"
#include "core/relief/occlusion/surface_bricks.h"

namespace dubsar {

/// Fills the bricks without surface (surface_bricks.h); false: cancelled. Same bytes for any number of threads.
bool measure_ahead(SurfaceBricks& bricks, Progress& progress);

}  // namespace dubsar
