#pragma once
// NRRD volumes (teem's "nearly raw raster data"): header and numbers in one file, or a header that names its data file.

#include <string_view>

#include "core/volume/formats/import_options.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Whether a file that begins like this is NRRD.
bool is_nrrd(std::string_view head) noexcept;

/// Encodings raw and gzip; 3 axes, or more of which all others have length 1. A data file of its own must lie in the
/// folder of the header (or in options.allow_external). Voxel size from "space directions" with "space units", or
/// "spacings" with "units"; anatomical spaces without a unit are taken as millimetres with a warning.
Result<OpenedVolume> open_nrrd(const ImportOptions& options);

}  // namespace dubsar
