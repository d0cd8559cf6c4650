#pragma once
// The density of a phantom at voxels, with partial volume, before anything images it.

#include "core/phantom/phantom.h"
#include "core/phantom/rasterise.h"
#include "core/volume/slab_source.h"

namespace dubsar::phantom {

/// Densities of the voxels of `box`, x fastest. Bricks are of the grid, so that a voxel has the same bits in every box.
/// All threads.
void rasterise_density(const Phantom& phantom, const VoxelBounds& box, float* out);

/// The same relative to the tablet's clay, as a source: what a scanner scans.
class DensitySource final : public SlabSource {
 public:
  explicit DensitySource(const Phantom& phantom);
  Dims dims() const noexcept override { return phantom_.options().dims; }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  const Phantom& phantom_;
  GridFrame frame_;
};

/// The grid of a phantom's scan.
GridFrame scan_frame(const PhantomOptions& options);

}  // namespace dubsar::phantom
