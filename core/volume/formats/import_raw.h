#pragma once
// Volumes without a header.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/volume/formats/import_options.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// options.raw must be set. kBadData when the file is smaller than the size given; bytes left over are a warning.
Result<OpenedVolume> open_raw(const ImportOptions& options);

/// How such a file is laid out, as VolumeInfo and the provenance of surfaces say it: "contiguous", or "contiguous
/// behind 512 bytes". And the bytes before the voxels of a layout that says so; none: it is no such layout.
std::string raw_layout(std::int64_t skip);
std::optional<std::int64_t> skip_of_layout(std::string_view layout);

}  // namespace dubsar
