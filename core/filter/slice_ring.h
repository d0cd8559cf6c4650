#pragma once
// The last few slices of a slab source, for filters that look at neighbours: a ring of slices with room beside the
// rows, so that a filter reads past both ends of a row without a branch.

#include <algorithm>
#include <cstdint>

#include "core/base/result.h"
#include "core/volume/brick_mask.h"
#include "core/volume/slab_source.h"
#include "core/volume/volume.h"

namespace dubsar {

/// Half-open range of slices.
struct SliceRange {
  std::int64_t begin = 0, end = 0;
  bool empty() const noexcept { return begin >= end; }
};

/// Holds up to `capacity` consecutive slices of a volume of `dims`. With padding, every row has kPad copies of its
/// first voxel before it and at least kPad of its last voxel after it, and rows start on 64-byte boundaries; without,
/// slices are contiguous. Not for several callers at once; distinct rows may be written by distinct threads.
class SliceRing {
 public:
  enum class Rows { kContiguous, kPadded };
  /// Voxels of padding on each side: one AVX-512 vector and the largest filter radius behind it.
  static constexpr std::int64_t kPad = 20;

  SliceRing(Dims dims, std::int64_t capacity, Rows rows);

  std::int64_t capacity() const noexcept { return capacity_; }
  std::int64_t bytes() const noexcept { return slices_.size() * static_cast<std::int64_t>(sizeof(float)); }

  /// A held slice.
  struct Slice {
    float* first;  ///< first voxel
    std::int64_t pitch, last_row;
    /// Row y, clamped to the volume.
    float* row(std::int64_t y) const noexcept { return first + std::clamp<std::int64_t>(y, 0, last_row) * pitch; }
  };
  /// Slice z, clamped to the volume; it must be held.
  Slice slice(std::int64_t z) noexcept {
    return {slices_.data() + std::clamp<std::int64_t>(z, 0, dims_.z - 1) % capacity_ * stride_ + lead_, pitch_,
            dims_.y - 1};
  }
  float* row(std::int64_t y, std::int64_t z) noexcept { return slice(z).row(y); }

  /// Fills the padding of a row from its first and last voxel.
  void pad_row(float* row) const noexcept;

  /// The part of `wanted` (cut to the volume) that has to be produced. Slices that are neither in `wanted` nor fit
  /// beside it are given up; what is held and wanted stays. Call hold() when the part is written.
  SliceRange missing(SliceRange wanted) noexcept;
  void hold(SliceRange produced) noexcept { held_.end = produced.end; }
  void forget() noexcept { held_ = {}; }

  /// Makes `wanted` (cut to the volume, at most `capacity` slices) available, reading what is not held from `source`.
  /// Padded rows get only their points in `points`; what else stands in them is nothing.
  Result<void> load(SlabSource& source, SliceRange wanted, const Wanted& points = {});

 private:
  Dims dims_;
  std::int64_t capacity_;
  std::int64_t lead_ = 0;    ///< floats before the first voxel of a row
  std::int64_t pitch_ = 0;   ///< floats from row to row
  std::int64_t stride_ = 0;  ///< floats from slice to slice
  SliceRange held_;
  Buffer<float> slices_;
  Buffer<float> staging_;  ///< contiguous slices on their way into padded rows
};

}  // namespace dubsar
