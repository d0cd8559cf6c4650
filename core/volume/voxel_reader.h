#pragma once
// What every volume importer delivers: a reader for boxes of the stored array, and the facts about it.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/numbers/scalar_type.h"
#include "core/base/result.h"
#include "core/volume/axis_order.h"
#include "core/volume/volume.h"

namespace dubsar {

/// Indices begin, begin + step, ... below end.
struct AxisRange {
  std::int64_t begin = 0, end = 0, step = 1;
  std::int64_t count() const noexcept { return end > begin ? (end - begin - 1) / step + 1 : 0; }
  std::int64_t at(std::int64_t i) const noexcept { return begin + i * step; }
  friend bool operator==(const AxisRange&, const AxisRange&) = default;
};

/// A box of the stored array, with a step along each axis.
struct VoxelBox {
  AxisRange x, y, z;
  Dims dims() const noexcept { return {x.count(), y.count(), z.count()}; }
  friend bool operator==(const VoxelBox&, const VoxelBox&) = default;
};

/// How a reader delivers numbers: as they are stored.
struct NumberFormat {
  ScalarType type = ScalarType::kF32;
  ByteOrder order = kNativeOrder;
  ScalarMap map;  ///< what they mean
  bool is_native_float() const noexcept { return type == ScalarType::kF32 && order == kNativeOrder && map.identity(); }
};

class VoxelReader {
 public:
  virtual ~VoxelReader() = default;
  virtual const NumberFormat& format() const noexcept = 0;
  virtual Dims dims() const noexcept = 0;
  /// Voxels along x, y and z that are decoded together; 1: no preference. Chunks start at voxel 0.
  virtual Dims chunk() const noexcept { return {1, 1, 1}; }
  /// Slices [begin, end) around slice z that are decoded together: reading them in one call is cheapest.
  virtual AxisRange layer_of(std::int64_t z) const noexcept {
    const std::int64_t depth = chunk().z, begin = z / depth * depth;
    return {begin, std::min(begin + depth, dims().z), 1};
  }
  /// Whether slices come in rising z only, so that going back means starting again.
  virtual bool sequential() const noexcept { return false; }
  /// Reads box.dims().count() stored numbers to the front of `out`, x fastest. One caller at a time; threads inside.
  virtual Result<void> read(const VoxelBox& box, std::span<std::byte> out) = 0;
};

struct VolumeCandidate {
  std::string dataset;
  std::vector<std::uint64_t> dims;  ///< slowest axis first, as stored
  std::string dtype;
};

/// How the numbers of a volume lie in its file.
struct StoredNumbers {
  std::string dtype;  ///< "uint8" ... "float64"
  std::string byte_order;
  std::string layout;  ///< "contiguous", "chunked 32x32x32" (z, y, x), ...
  std::vector<std::string> filters;
  std::int64_t storage_bytes = 0;  ///< in the file, compressed
  std::int64_t logical_bytes = 0;  ///< of the whole array
  bool may_have_nonfinite = true;  ///< a float type
};

/// What is known of a volume in a file, for the report and `dubsar info`.
struct VolumeInfo {
  std::string path;
  std::string fingerprint;  ///< of that file (file_fingerprint.h); empty: a folder
  std::string format;       ///< "hdf5", "raw", "nrrd", "tiff"
  std::string dataset;      ///< HDF5 path, empty for other formats
  std::string found_by;     ///< how the volume was found: "named by the user", "NeXus default", ...
  Dims file_dims;           ///< of the whole array, along x, y, z of the object
  AxisOrder axes;           ///< how these lie in the file
  StoredNumbers stored;
  ScalarMap map;  ///< applied to the stored numbers
  VoxelSize voxel;
  VoxelBox box;                             ///< crop and stride that are read
  std::vector<VolumeCandidate> candidates;  ///< other volumes in the file
  std::vector<std::string> warnings;        ///< for people, one sentence each
};

/// A file opened by an importer: dims and voxel size of the info follow the stored axes, fastest first, and the reader
/// too. open_volume() turns them to x, y, z by info.axes.
struct OpenedVolume {
  VolumeInfo info;
  std::vector<std::filesystem::path> files;  ///< that hold it, besides the one that was asked for
  bool voxel_by_name = false;                ///< the voxel size was stated for x, y and z by name: it is not turned
  std::unique_ptr<VoxelReader> reader;
};

/// Whether numbers of this kind can be NaN or Inf as floats: floats, integers some of which are no measurement, and
/// those whose map leads beyond 3.4e38.
bool can_be_nonfinite(ScalarType type, const ScalarMap& map) noexcept;

/// Copies one row of a box: x.count() numbers of 1, 2, 4 or 8 bytes; `from` points at the one at x.begin.
void copy_row(const std::byte* from, std::int64_t number_bytes, const AxisRange& x, std::byte* to);

}  // namespace dubsar
