#pragma once
// How far rays may go from where no surface is.

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/relief/occlusion/surface_bricks.h"

namespace dubsar {

/// Fills `away` and chooses `block_bits` from the bricks. kCancelled; kTryAgain: too many blocks.
Result<void> measure_away(SurfaceBricks& bricks, Progress& progress);

}  // namespace dubsar
