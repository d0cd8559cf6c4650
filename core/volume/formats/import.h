#pragma once
// One door for every volume format: open_volume() looks at the contents, checks them and gives a slab source.

#include <memory>

#include "core/volume/formats/import_options.h"
#include "core/volume/measured_source.h"
#include "core/volume/slab_source.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// A volume file as a slab source: cropped, decimated, in millimetres where the file or the user says so; voxels that
/// are no measurement count as air (unmeasured.h). frame() maps the processed grid to the voxels of the file.
class ImportedVolume final : public SlabSource {
 public:
  ImportedVolume(VolumeInfo info, std::unique_ptr<MeasuredSource> source)
      : info_(std::move(info)), source_(std::move(source)) {}

  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  std::int64_t preferred_height() const noexcept override { return source_->preferred_height(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    return source_->read(z_begin, z_end, out);
  }

  const VolumeInfo& info() const noexcept { return info_; }
  /// What of it is no measurement; some slices are read for it the first time. Errors of find_unmeasured().
  Result<Unmeasured> unmeasured() { return source_->unmeasured(); }
  /// Such voxels in the slices read so far; each slice counts once.
  const MeasuredSource::Counts& unmeasured_counts() const noexcept { return source_->counts(); }
  /// Slices without a measurement that were bridged, of those read so far; of the part that is read.
  std::vector<std::int64_t> bridged() const { return source_->bridged(); }

 private:
  VolumeInfo info_;
  std::unique_ptr<MeasuredSource> source_;
};

/// Format by content, never by suffix: HDF5, NRRD, TIFF (a file or a folder of slices); raw when options.raw is set.
/// Nothing but headers is read here. Errors: kNoInput, kPermission, kUsage (crop outside the volume), kBadData in one
/// sentence for everything that is not a volume.
Result<std::unique_ptr<ImportedVolume>> open_volume(ImportOptions options);

/// The same as a reader of any box, along x, y, z of the object, in numbers as stored; for those who look at parts of a
/// volume. options.crop, .stride and what is said about ignored values do nothing here.
struct OpenedVoxels {
  VolumeInfo info;
  std::unique_ptr<VoxelReader> reader;
};
Result<OpenedVoxels> open_voxels(ImportOptions options);

}  // namespace dubsar
