#pragma once
// TIFF stacks: a multi-page file, a folder of slices, or a pattern such as scan/slice_*.tif.

#include "core/volume/formats/import_options.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Slices of a folder or pattern are ordered by name (slice_names.h). All slices must have the same size, type and
/// orientation: 8 to 64 bits, one channel. Voxel size from the description (ImageJ, OME, tifffile) or the resolution
/// tags (z taken like x when only these are there, with a warning); axes from the orientation (tag 274). kBadData in
/// one sentence for colour pictures, a single picture, channels and time points, several series, slices that differ,
/// damaged files.
Result<OpenedVolume> open_tiff_stack(const ImportOptions& options);

/// Whether `path` is a pattern with * or ? in its last part.
bool is_slice_pattern(const std::filesystem::path& path);

}  // namespace dubsar
