#pragma once
// The voxel size an HDF5 file states, and where it states it.

#include <string>
#include <vector>

#include "core/volume/formats/hdf5_search.h"
#include "core/volume/volume.h"

namespace dubsar {

struct StatedVoxelSize {
  VoxelSize size;        ///< along the stored axes, fastest first, unless by_name
  bool by_name = false;  ///< stated for x, y and z, wherever these are stored
};

/// First hit of: NXdata axes with @units (also EMD dim vectors), attributes and sibling datasets such as
/// element_size_um, pixelResolution, voxel_size, pixel_size with their units, VTKHDF Spacing. The provenance is empty
/// when nothing was found; sizes without a unit are reported in `warnings` and not used.
StatedVoxelSize hdf5_voxel_size(const Hdf5Volume& volume, std::vector<std::string>& warnings);

}  // namespace dubsar
