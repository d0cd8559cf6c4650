#pragma once
// Crop and stride: a reader of the stored array as a slab source of the processed grid.

#include <memory>
#include <optional>

#include "core/base/files/scratch_file.h"
#include "core/base/system/budget.h"
#include "core/volume/slab_source.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Reads the voxels of `box` and no others, apart from those that share a compressed chunk with them. A layer of chunks
/// is decoded once, however few of its slices are asked for at a time: it is kept as stored until a slice of another
/// layer is asked for, in memory when it fits a quarter of the budget, else in a scratch file (budget.scratch_folder),
/// decoded by rows of chunks. Slabs of preferred_height() that begin at a multiple of it need neither.
class GridSource final : public SlabSource {
 public:
  GridSource(std::unique_ptr<VoxelReader> reader, const VoxelBox& box, VoxelSize voxel, Budget budget = {});

  Dims dims() const noexcept override { return dims_; }
  const GridFrame& frame() const noexcept override { return frame_; }
  std::int64_t preferred_height() const noexcept override;
  /// Errors: those of the reader; kIo, kCannotCreate, kPermission of the scratch file.
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

  /// Bytes of the layer that is kept in memory now.
  std::int64_t kept_bytes() const noexcept { return kept_.size(); }

 private:
  struct Slices {
    std::int64_t begin = 0, end = 0;  ///< of the grid
    bool holds(std::int64_t k) const noexcept { return k >= begin && k < end; }
    friend bool operator==(const Slices&, const Slices&) = default;
  };
  Slices layer_of(std::int64_t k) const noexcept;
  VoxelBox box_of(const Slices& slices) const noexcept;
  /// Straight from the file.
  Result<void> fetch(const Slices& slices, std::span<float> out);
  Result<void> keep(const Slices& layer);
  Result<void> spill(const Slices& layer);
  Result<void> from_kept(const Slices& slices, std::span<float> out);
  void convert(const std::byte* from, std::span<float> out) const;

  std::unique_ptr<VoxelReader> reader_;
  VoxelBox box_;
  Dims dims_;
  GridFrame frame_;
  Budget budget_;
  Slices layer_;            ///< what kept_ or scratch_ hold
  Buffer<std::byte> kept_;  ///< as stored; empty while the layer lies in the scratch file
  Buffer<std::byte> piece_;
  std::optional<ScratchFile> scratch_;
};

}  // namespace dubsar
