#pragma once
// A volume that is read in slabs of z-slices: files, phantoms and filters are all slab sources, so that a scan larger
// than memory runs through a chain of them. Filters pull from the source above them.

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/volume/volume.h"

namespace dubsar {

class SlabSource {
 public:
  virtual ~SlabSource() = default;
  virtual Dims dims() const noexcept = 0;
  virtual const GridFrame& frame() const noexcept = 0;
  /// Slices that are cheapest to ask for in one call that begins at a multiple of them; 1: no preference.
  virtual std::int64_t preferred_height() const noexcept { return 1; }
  /// Writes slices [z_begin, z_end) to the front of `out`, at least dims().slice() * (z_end - z_begin) floats, x
  /// fastest. One
  /// caller at a time; the source may use all threads inside. Reading in rising order is fastest; any order works.
  virtual Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) = 0;
};

/// A volume in memory as a source; borrows the volume.
class VolumeSource final : public SlabSource {
 public:
  explicit VolumeSource(const Volume<float>& volume, GridFrame frame = {})
      : volume_(&volume), frame_(std::move(frame)) {}
  Dims dims() const noexcept override { return volume_->dims; }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  const Volume<float>* volume_;
  GridFrame frame_;
};

}  // namespace dubsar
