#pragma once
// The front part of a stored array: files that pad their volumes to whole chunks.

#include <memory>

#include "core/volume/voxel_reader.h"

namespace dubsar {

/// A reader of voxels [0, dims) of `whole`, none of which is larger than those of the array.
std::unique_ptr<VoxelReader> make_front_reader(std::unique_ptr<VoxelReader> whole, const Dims& dims);

}  // namespace dubsar
