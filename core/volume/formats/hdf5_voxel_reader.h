#pragma once
// Reads boxes of a chunked or otherwise packed HDF5 dataset.

#include <array>
#include <memory>

#include "core/hdf5/hdf5_file.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Whether all chunks can be decoded here, by all threads and without a plug-in: plain numbers, filters of
/// chunk_filters.h only. `axes`: which stored axes are z, y, x; all others have length 1.
bool decodes_chunks(const Hdf5DatasetInfo& info, const std::array<std::size_t, 3>& axes);

/// The reader keeps the file open. What decodes_chunks() says no to goes through the library, which uses one thread.
Result<std::unique_ptr<VoxelReader>> make_hdf5_reader(std::shared_ptr<Hdf5File> file, const Hdf5DatasetInfo& info,
                                                      const std::array<std::size_t, 3>& axes, const ScalarMap& map);

}  // namespace dubsar
