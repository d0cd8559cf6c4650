#pragma once
// Which parts of a large grid are wanted: one bit for each brick of 8x8x8 points.

#include <cstdint>
#include <vector>

#include "core/volume/volume.h"

namespace dubsar {

/// Half-open range of points of a row.
struct Span {
  std::int64_t begin = 0, end = 0;
  friend bool operator==(const Span&, const Span&) = default;
};

/// A mask of 3.2 thousand million points takes 0.8 MB. Distinct rows of bricks may be written by distinct threads.
class BrickMask {
 public:
  static constexpr std::int64_t kEdge = 8;

  BrickMask() = default;
  explicit BrickMask(const Dims& dims);

  const Dims& dims() const noexcept { return dims_; }
  const Dims& bricks() const noexcept { return bricks_; }
  std::int64_t words_per_row() const noexcept { return words_; }
  /// The bricks of one row along x, 64 a word.
  std::uint64_t* row(std::int64_t by, std::int64_t bz) noexcept {
    return bits_.data() + (bz * bricks_.y + by) * words_;
  }
  const std::uint64_t* row(std::int64_t by, std::int64_t bz) const noexcept {
    return bits_.data() + (bz * bricks_.y + by) * words_;
  }
  bool get(std::int64_t bx, std::int64_t by, std::int64_t bz) const noexcept {
    return (row(by, bz)[bx >> 6] >> (bx & 63) & 1u) != 0;
  }
  void set(std::int64_t bx, std::int64_t by, std::int64_t bz) noexcept {
    row(by, bz)[bx >> 6] |= std::uint64_t{1} << (bx & 63);
  }
  void set_all() noexcept;
  /// Marked bricks.
  std::int64_t count() const noexcept;

  /// Points of row (y, z) that are within `reach` points, along each axis, of a marked brick: rising, apart.
  void spans(std::int64_t y, std::int64_t z, std::int64_t reach, std::vector<Span>& out) const;
  /// Is there any such point in slices [z_begin, z_end)?
  bool any(std::int64_t z_begin, std::int64_t z_end, std::int64_t reach) const noexcept;

 private:
  Dims dims_, bricks_;
  std::int64_t words_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// What a filter has to make: the points within `reach` of the marked bricks; without a mask, all.
struct Wanted {
  const BrickMask* mask = nullptr;
  std::int64_t reach = 0;

  /// The same with a wider reach: what a filter has to see for it.
  Wanted wider(std::int64_t by) const noexcept { return {mask, reach + by}; }
  bool any(std::int64_t z_begin, std::int64_t z_end) const noexcept {
    return mask == nullptr || mask->any(z_begin, z_end, reach);
  }
  /// Of row (y, z) of `points` points.
  void spans(std::int64_t points, std::int64_t y, std::int64_t z, std::vector<Span>& out) const {
    if (mask == nullptr)
      out.assign(1, {0, points});
    else
      mask->spans(y, z, reach, out);
  }
};

}  // namespace dubsar
