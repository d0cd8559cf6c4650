#pragma once
// What a scanned object stands in: a block of foam or plastic, cut to its shape.

#include "core/phantom/phantom.h"
#include "core/phantom/rasterise.h"

namespace dubsar::phantom {

/// Adds the holder of the options to densities of the voxels of `box`, x fastest: below a fifth of the grid's height it
/// fills an elliptical cylinder around the object, of 9/10 of the grid's sides, and touches the clay; nothing of it is
/// within the envelope. The truth does not know it. All threads.
void add_holder(const Phantom& phantom, const VoxelBounds& box, float* out);

}  // namespace dubsar::phantom
