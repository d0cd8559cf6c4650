#pragma once
// A stored array read along the axes of the object.

#include <memory>

#include "core/volume/axis_order.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Boxes in x, y, z of the object from a reader of the stored array. Axes that change places within a slice, and axes
/// that are backwards, cost nothing to speak of. When z is not the slowest stored axis, a slab crosses the whole file:
/// chunks are still decoded once a layer; flat files and streams are read in layers of up to `layer_bytes`, one pass
/// over the file a layer (layer_of() says which slices). Memory: 32 MiB, or the chunks across a layer if they are
/// larger.
class OrientedReader final : public VoxelReader {
 public:
  OrientedReader(std::unique_ptr<VoxelReader> stored, const AxisOrder& order, std::uint64_t layer_bytes);

  Dims dims() const noexcept override { return dims_; }
  const NumberFormat& format() const noexcept override { return stored_->format(); }
  Dims chunk() const noexcept override;
  AxisRange layer_of(std::int64_t z) const noexcept override;
  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override;

 private:
  std::unique_ptr<VoxelReader> stored_;
  AxisOrder order_;
  Dims dims_;
  std::int64_t layer_ = 1;  ///< slices of a layer where the stored chunks do not say
  std::vector<std::byte> piece_;
};

}  // namespace dubsar
