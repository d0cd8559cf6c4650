#pragma once
// What an HDF5 file says about numbers of a volume that are no measurement.

#include "core/base/numbers/scalar_type.h"
#include "core/volume/formats/hdf5_search.h"

namespace dubsar {

/// _FillValue, missing_value (one or several), valid_min, valid_max and valid_range as netCDF and CF have them, and
/// what others call nodata or fill_value; in netCDF files without _FillValue the value that HDF5 itself fills with.
/// They speak of numbers as stored, but for a range of floats where whole numbers are packed with `map`, which is of
/// what they mean (CF 1.11, 8.1; netCDF User's Guide, appendix A).
NoMeasurement hdf5_no_measurement(const Hdf5Volume& volume, const ScalarMap& map);

}  // namespace dubsar
