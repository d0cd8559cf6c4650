#pragma once
// One door for every volume format: open_volume() looks at the contents, checks them and gives a slab source.

#include <memory>

#include "core/volume/finite_source.h"
#include "core/volume/formats/import_options.h"
#include "core/volume/slab_source.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// A volume file as a slab source: cropped, decimated, in millimetres where the file or the user says so, without NaN
/// and Inf. frame() maps the processed grid to the voxels of the file.
class ImportedVolume final : public SlabSource {
 public:
  ImportedVolume(VolumeInfo info, std::unique_ptr<SlabSource> source, FiniteSource* finite)
      : info_(std::move(info)), source_(std::move(source)), finite_(finite) {}

  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  std::int64_t preferred_height() const noexcept override { return source_->preferred_height(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    return source_->read(z_begin, z_end, out);
  }

  const VolumeInfo& info() const noexcept { return info_; }
  /// NaN and Inf replaced in the slices read so far; each slice counts once.
  std::int64_t nonfinite_count() const noexcept { return finite_ != nullptr ? finite_->count() : 0; }
  /// What they were replaced by; 0 while there were none.
  float nonfinite_fill() const noexcept { return finite_ != nullptr ? finite_->fill() : 0.0F; }

 private:
  VolumeInfo info_;
  std::unique_ptr<SlabSource> source_;
  FiniteSource* finite_;  ///< inside source_; nullptr for integers
};

/// Format by content, never by suffix: HDF5, NRRD, TIFF (a file or a folder of slices); raw when options.raw is set.
/// Nothing but headers is read here. Errors: kNoInput, kPermission, kUsage (crop outside the volume), kBadData in one
/// sentence for everything that is not a volume.
Result<std::unique_ptr<ImportedVolume>> open_volume(ImportOptions options);

/// The same as a reader of any box, along x, y, z of the object, in numbers as stored; for those who look at parts of a
/// volume. options.crop, .stride and .nonfinite_fill do nothing here.
struct OpenedVoxels {
  VolumeInfo info;
  std::unique_ptr<VoxelReader> reader;
};
Result<OpenedVoxels> open_voxels(ImportOptions options);

}  // namespace dubsar
