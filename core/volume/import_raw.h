#pragma once
// Volumes without a header.

#include "core/volume/import_options.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// options.raw must be set. kBadData when the file is smaller than the size given; bytes left over are a warning.
Result<OpenedVolume> open_raw(const ImportOptions& options);

}  // namespace dubsar
