#pragma once
// Scans that are not of tablets go through, and no part of them is called one.

#include <string>

namespace dubsar {

/// Processes every HDF5 file in a folder without options and prints its parts, time and memory. Returns how many of
/// them failed or have a part called tablet.
int print_real_volumes(const std::string& folder);

}  // namespace dubsar
