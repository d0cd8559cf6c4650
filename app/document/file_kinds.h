#pragma once
// What files are by their names: surfaces, and scans.

#include <filesystem>
#include <string_view>

#include "core/base/result.h"

namespace dubsar::app {

/// The surfaces that can be read, as sentences name them.
inline constexpr std::string_view kSurfaceSuffixes = ".exa, .ply, .obj, .stl or .glb";
/// Whether a name ends in one of them, in capitals or not.
bool names_a_surface(const std::filesystem::path& path);

/// A scan in one file: HDF5 and NRRD.
bool names_a_scan(const std::filesystem::path& path);
/// A picture that may be a slice of a scan: TIFF.
bool names_a_slice(const std::filesystem::path& path);

/// kNoInput: no such file; kUsage: a folder, or no surface by its name. What is in it is not looked at.
Result<void> check_surface_file(const std::filesystem::path& file);

}  // namespace dubsar::app
