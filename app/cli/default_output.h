#pragma once
// The name of an output that was not given: beside the input.

#include <string>

namespace dubsar::app {

/// "scans/tablet.exa" and "_fatcross.tif" give "scans/tablet_fatcross.tif". The input may be a folder, or end in a
/// data set ("scan.h5:/entry/data"). Empty where the input is.
std::string output_beside(const std::string& in, const std::string& tail);

/// A name as it must be typed in a shell: as it is, or in single quotes.
std::string quoted(const std::string& name);

}  // namespace dubsar::app
