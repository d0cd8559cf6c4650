#pragma once
// What every volume importer delivers: a reader for boxes of the stored array, and the facts about it.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/scalar_type.h"
#include "core/volume/volume.h"

namespace dubsar {

/// Indices begin, begin + step, ... below end.
struct AxisRange {
  std::int64_t begin = 0, end = 0, step = 1;
  std::int64_t count() const noexcept { return end > begin ? (end - begin + step - 1) / step : 0; }
  std::int64_t at(std::int64_t i) const noexcept { return begin + i * step; }
  friend bool operator==(const AxisRange&, const AxisRange&) = default;
};

/// A box of the stored array, with a step along each axis.
struct VoxelBox {
  AxisRange x, y, z;
  Dims dims() const noexcept { return {x.count(), y.count(), z.count()}; }
  friend bool operator==(const VoxelBox&, const VoxelBox&) = default;
};

class VoxelReader {
 public:
  virtual ~VoxelReader() = default;
  /// Of the stored array.
  virtual Dims dims() const noexcept = 0;
  /// Slices that are decoded together (chunk depth): reading them in one call is cheapest. 1: no preference.
  virtual std::int64_t layer_depth() const noexcept { return 1; }
  /// Reads box.dims().count() values to `out`, x fastest. One caller at a time; threads inside.
  virtual Result<void> read(const VoxelBox& box, std::span<float> out) = 0;
};

struct VolumeCandidate {
  std::string dataset;
  std::vector<std::uint64_t> dims;  ///< slowest axis first, as stored
  std::string dtype;
};

/// What is known of a volume in a file, for the report and `dubsar info`.
struct VolumeInfo {
  std::string path;
  std::string format;    ///< "hdf5", "raw", "nrrd", "tiff"
  std::string dataset;   ///< HDF5 path, empty for other formats
  std::string found_by;  ///< how the volume was found: "named by the user", "NeXus default", ...
  Dims file_dims;        ///< of the stored array
  std::string dtype;     ///< "uint8" ... "float64"
  std::string byte_order;
  std::string layout;  ///< "contiguous", "chunked 32x32x32" (z, y, x), ...
  std::vector<std::string> filters;
  ScalarMap map;  ///< applied to the stored numbers
  VoxelSize voxel;
  std::int64_t storage_bytes = 0;           ///< in the file, compressed
  std::int64_t logical_bytes = 0;           ///< of the whole array
  VoxelBox box;                             ///< crop and stride that are read
  std::vector<VolumeCandidate> candidates;  ///< other volumes in the file
  std::vector<std::string> warnings;        ///< for people, one sentence each
  bool may_have_nonfinite = true;           ///< a float type
};

/// A file opened by an importer.
struct OpenedVolume {
  VolumeInfo info;
  std::unique_ptr<VoxelReader> reader;
};

/// Stores one row of a box: `from` points at the stored number at x.begin.
void store_row(const std::byte* from, ScalarType type, ByteOrder order, const ScalarMap& map, const AxisRange& x,
               std::span<float> out);

}  // namespace dubsar
