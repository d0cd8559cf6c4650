#pragma once
// Which dataset of an HDF5 file is the volume: the conventions of the field in a fixed order, then the largest array.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/hdf5/hdf5_file.h"
#include "core/volume/formats/import_options.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

struct Hdf5Volume {
  std::shared_ptr<Hdf5File> file;        ///< the file that holds it: another one behind an allowed external link
  Hdf5DatasetInfo info;                  ///< of the dataset in that file
  std::shared_ptr<Hdf5File> named_file;  ///< the file that was asked for
  std::string named;                     ///< the path in that file
  std::string found_by;
  std::vector<VolumeCandidate> others;
};

/// The axes of a stored array that are z, y, x: all three of rank 3; of a higher rank those that are left without axes
/// of length 1. nullopt when that does not leave three.
std::optional<std::array<std::size_t, 3>> volume_axes(const std::vector<std::uint64_t>& dims);

/// "256x128x128 uint16"
std::string describe_array(const Hdf5DatasetInfo& info);

/// Order: --dataset; NeXus @default/@signal, then NXtomoproc; nabu; Data Exchange; VTKHDF ImageData; the largest array
/// of rank 3 (level 0 of a pyramid). kBadData in one sentence: projections, nothing that is a volume, two candidates
/// within a factor of 2 in size.
Result<Hdf5Volume> find_hdf5_volume(std::shared_ptr<Hdf5File> file, const ImportOptions& options);

}  // namespace dubsar
