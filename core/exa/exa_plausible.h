#pragma once
// Numbers of a surface that are finite, and still nonsense: what a file whose sums are right can hold.

#include "core/base/result.h"
#include "core/exa/exa_text.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// kBadData with what was found and where: a vertex far from its crossings or outside of the grid, a normal that is no
/// unit vector, a curvature that no grid can show, a patch triangle with two equal corners, a voxel size or place
/// beyond all scanners, a provenance that is no JSON, normals that the header announces and that are not there. One
/// build_quad_mesh().
Result<void> check_plausible(const SurfaceModel& model, const ExaHeader& header, Progress& progress);

}  // namespace dubsar
