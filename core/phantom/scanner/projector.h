#pragma once
// Line integrals of a volume along the rays of a scan, and the volume back from them.

#include "core/base/progress.h"
#include "core/phantom/scanner/columns.h"
#include "core/phantom/scanner/geometry.h"

namespace dubsar::phantom {

/// Joseph's integrator ([Joseph 1982]): where a ray crosses the planes of voxels of the axis that it runs along most,
/// the volume is interpolated linearly; times the length between two planes. `object`: planes x, columns y, rows z.
/// Gives planes of views, columns and rows of the panel, in units of the object times mm. Pixels and voxels are alike,
/// so that the linear interpolation stands for the area of both (variance 1/6 voxel squared across the ray); against
/// chords of a ball of 18 voxels the root of the mean square of the error is .2 % of the longest, up to .9 of the
/// radius. Air outside the grid. All threads, the same bits for any number. Cost: .2 to 1.5 ns a voxel and view.
/// kCancelled.
Result<Columns> project(const Columns& object, const ScanGeometry& geometry, Progress& progress);

/// Filtered backprojection of -ln(light) over a half or full turn; in a cone that of [Feldkamp 1984], over half a turn
/// with the weights of [Parker 1982]. The ramp is that of the sampled kernel 1/4, -1/(pi n)^2 at odd n ([Kak
/// 1988], 3.3), padded to twice the width, and interpolated to half a pixel by the transform, then linearly. Voxels
/// that a view does not see get nothing of it. Units of `projections` per mm. Where the panel is too low its last rows
/// are repeated. All threads, the same bits for any number. kCancelled.
Result<Columns> reconstruct(const Columns& projections, const ScanGeometry& geometry, Window window,
                            Progress& progress);

}  // namespace dubsar::phantom
