#pragma once
// The scan of a phantom as a slab source: density with partial volume, noise, and the scanner's PSF over both.

#include <memory>
#include <vector>

#include "core/phantom/artefacts.h"
#include "core/phantom/phantom.h"
#include "core/volume/slab_source.h"

namespace dubsar::phantom {

/// density = PSF * (partial volume of clay, organic matter and grains + white noise) + artefacts. The PSF has three
/// voxels per axis and the deviation of the options, usually that of [1 4 1]/6: the noise is correlated as in a CT
/// scan, and Gauss with 2:1 takes 17 dB to 23 dB as in the paper (table 2); with the voxel's own extent the edge spread
/// has a standard deviation of 0.65 voxel. Of a PSF wider than .8 voxel what is more than usual comes before the noise,
/// by three voxels per axis, too: a wide focal spot, and motion. The bits of a voxel depend on the options and its
/// place only, not on slabs, threads or processor.
///
/// Cost: about 30 Mvox/s a core on the paper preset; keeps the slices of one request of up to 16 plus 2 or 4.
class PhantomSource final : public SlabSource {
 public:
  explicit PhantomSource(std::shared_ptr<const Phantom> phantom);
  Dims dims() const noexcept override { return phantom_->options().dims; }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

  /// Standard deviation of the noise in the scan; 0 for an infinite signal to noise ratio.
  double sigma() const noexcept { return sigma_; }

 private:
  void fill_raw(std::int64_t z_begin, std::int64_t z_end);
  void add_noise(std::int64_t y, std::int64_t z, std::span<float> row) const;
  void blur_once(std::int64_t z_begin, std::int64_t z_end);
  /// From x = -halo_ on.
  float* raw_row(std::int64_t y, std::int64_t z) noexcept {
    return raw_.data() + ((z - raw_begin_) * (dims().y + 2 * halo_) + y + halo_) * (dims().x + 2 * halo_);
  }

  std::shared_ptr<const Phantom> phantom_;
  GridFrame frame_;
  double sigma_ = 0.0;
  ScanArtefacts artefacts_;
  double middle_ = 4.0;        ///< weight of the PSF, see imaging_kernels.h
  double first_middle_ = 4.0;  ///< of the pass before it, where there are two
  std::int64_t halo_ = 1;      ///< passes of the PSF, and voxels that they look beyond the grid
  // Unblurred slices [raw_begin_, raw_end_), halo_ voxels wider than the grid on each side.
  std::vector<float> raw_;
  std::int64_t raw_begin_ = 0, raw_end_ = 0;
  std::vector<float> once_;  ///< after the first of two passes, one voxel wider than the grid
};

}  // namespace dubsar::phantom
