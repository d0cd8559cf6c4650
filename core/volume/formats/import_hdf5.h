#pragma once
// HDF5 volumes: search, checks before anything is read, and the fastest safe way to read.

#include <string>
#include <vector>

#include "core/volume/formats/import_options.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Opens the volume of an HDF5 file (see hdf5_search.h for which one). Contiguous plain numbers are read with pread,
/// chunks stored plain or with shuffle and deflate are decoded by all threads, everything else goes through the
/// library. Refused in one sentence (kBadData): projections, pictures, compound and string types, empty arrays, arrays
/// that were never or only partly written, missing or unsafe filters, data in other files (unless
/// options.allow_external holds them), sizes beyond the budget, damaged files.
Result<OpenedVolume> open_hdf5(const ImportOptions& options);

/// Compression filters that volumes may use, and how to get those that are missing.
struct Hdf5FilterState {
  std::string name;
  bool available = false;
  std::string remedy;  ///< e.g. "apt install hdf5-plugin-lzf"
};
std::vector<Hdf5FilterState> hdf5_filter_states();

}  // namespace dubsar
