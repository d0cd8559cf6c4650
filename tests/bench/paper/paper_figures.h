#pragma once
// A surface coded as in the paper, beside the bits that the paper prints.

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Prints a table of bits a vertex (paper, tables 2 and 3: a scan of 10 million vertices). kUsage: a surface whose
/// parts touch, which that code does not hold.
Result<void> print_paper_figures(SurfaceModel model, Progress& progress);

}  // namespace dubsar
