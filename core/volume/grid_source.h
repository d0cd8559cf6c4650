#pragma once
// Crop and stride: a reader of the stored array as a slab source of the processed grid.

#include <memory>
#include <vector>

#include "core/volume/slab_source.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Reads the voxels of `box` and no others, apart from those that share a compressed chunk with them. Chunks that reach
/// over the slab being read are kept for the next one, up to 512 MiB.
class GridSource final : public SlabSource {
 public:
  GridSource(std::unique_ptr<VoxelReader> reader, const VoxelBox& box, VoxelSize voxel);

  Dims dims() const noexcept override { return dims_; }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  /// Slices [k_begin, k_end) of the grid straight from the file.
  Result<void> fetch(std::int64_t k_begin, std::int64_t k_end, std::span<float> out);

  std::unique_ptr<VoxelReader> reader_;
  VoxelBox box_;
  Dims dims_;
  GridFrame frame_;
  std::vector<float> layer_;  ///< slices [layer_begin_, layer_end_) of the grid
  std::int64_t layer_begin_ = 0, layer_end_ = 0;
};

}  // namespace dubsar
