#pragma once
// Imaris files (.ims): HDF5 whose volumes are padded to whole chunks, with texts as arrays of characters.

#include <optional>

#include "core/volume/axis_order.h"
#include "core/volume/formats/hdf5_search.h"

namespace dubsar {

/// Where the volume at full resolution lies.
inline constexpr const char* kImarisFinest = "/DataSet/ResolutionLevel 0";

/// The size of an Imaris volume without its padding: ImageSizeX, Y, Z of its group. nullopt: no Imaris volume, or a
/// size that does not fit into `stored`.
std::optional<Dims> imaris_dims(const Hdf5Volume& volume, const Dims& stored);

/// ExtMin and ExtMax of DataSetInfo/Image over its size, by their unit (micrometres where none is said).
std::optional<VoxelSize> imaris_voxel_size(const Hdf5Volume& volume);

/// Which axes an Imaris volume has stored from their far end: ExtMin above ExtMax. nullopt: no Imaris volume, or none.
std::optional<AxisOrder> imaris_axis_order(const Hdf5Volume& volume);

}  // namespace dubsar
