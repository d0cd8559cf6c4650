#pragma once
// What an HDF5 file says about the order of the axes of its volume.

#include <string>
#include <vector>

#include "core/volume/axis_order.h"
#include "core/volume/formats/hdf5_search.h"

namespace dubsar {

/// First hit of: attributes axis_order and the like of the volume, DIMENSION_LABELS, axistags (vigra), axisLabels
/// (openPMD, with dataOrder), axes (Data Exchange, NXdata, N5), names of EMD dim vectors, VTKHDF Direction; then
/// axis_order and the like of the groups above. Labels that do not name x, y and z are not used, with a warning where
/// they stand in an attribute for the order of axes; so are labels that contradict the first hit. The usual order,
/// without provenance, when nothing is said.
AxisOrder hdf5_axis_order(const Hdf5Volume& volume, std::vector<std::string>& warnings);

}  // namespace dubsar
