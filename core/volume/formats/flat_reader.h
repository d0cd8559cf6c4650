#pragma once
// Reads boxes of an array of numbers that lies uncompressed in one or more files: raw volumes, NRRD, contiguous HDF5.

#include <vector>

#include "core/base/files/input_file.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Bytes [begin, begin + bytes) of the array lie at `offset` of the file.
struct FlatSegment {
  InputFile file;
  std::int64_t offset = 0;
  std::int64_t bytes = 0;
};

struct FlatLayout {
  Dims dims;
  NumberFormat format;
  std::vector<FlatSegment> segments;  ///< in the order of the array
};

/// kBadData when the segments hold fewer bytes than the array, or reach beyond the end of their files.
Result<std::unique_ptr<VoxelReader>> make_flat_reader(FlatLayout layout);

}  // namespace dubsar
