#pragma once
// Dimension scales (HDF5 high level, netCDF-4): arrays of coordinates that belong to the axes of a volume.

#include <array>
#include <optional>
#include <string>

#include "core/volume/formats/hdf5_search.h"

namespace dubsar {

/// The scales of z, y, x as stored, slowest first; an empty name where an axis has none. nullopt: none has.
std::optional<std::array<std::string, 3>> hdf5_scales(const Hdf5File& file, const Hdf5DatasetInfo& info);

}  // namespace dubsar
