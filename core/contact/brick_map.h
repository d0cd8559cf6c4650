#pragma once
// Values at few points of a large grid: bricks of 8x8x8 points are made where somebody writes.

#include <array>
#include <cstdint>
#include <vector>

#include "core/volume/volume.h"

namespace dubsar {

template <class T>
class BrickMap {
 public:
  static constexpr std::int64_t kEdge = 8;

  /// `none` is the value of every point that was not written, and of points outside the grid.
  BrickMap(Dims dims, T none)
      : dims_(dims),
        bricks_{(dims.x + kEdge - 1) / kEdge, (dims.y + kEdge - 1) / kEdge, (dims.z + kEdge - 1) / kEdge},
        none_(none),
        place_(static_cast<std::size_t>(bricks_.count()), kNoBrick) {}

  const Dims& dims() const noexcept { return dims_; }
  const Dims& bricks() const noexcept { return bricks_; }

  T get(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    if (x < 0 || y < 0 || z < 0 || x >= dims_.x || y >= dims_.y || z >= dims_.z) return none_;
    const std::uint32_t place = place_[brick_of(x, y, z)];
    return place == kNoBrick ? none_ : values_[place + inside(x, y, z)];
  }
  /// The point must lie in the grid.
  T& at(std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint32_t& place = place_[brick_of(x, y, z)];
    if (place == kNoBrick) {
      place = static_cast<std::uint32_t>(values_.size());
      values_.resize(values_.size() + kEdge * kEdge * kEdge, none_);
    }
    return values_[place + inside(x, y, z)];
  }
  /// Is there a brick at these brick coordinates (rising by one from brick to brick)?
  bool has_brick(std::int64_t bx, std::int64_t by, std::int64_t bz) const noexcept {
    return place_[static_cast<std::size_t>((bz * bricks_.y + by) * bricks_.x + bx)] != kNoBrick;
  }

 private:
  static constexpr std::uint32_t kNoBrick = 0xffffffffu;
  std::size_t brick_of(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    return static_cast<std::size_t>(((z / kEdge) * bricks_.y + y / kEdge) * bricks_.x + x / kEdge);
  }
  static std::uint32_t inside(std::int64_t x, std::int64_t y, std::int64_t z) noexcept {
    return static_cast<std::uint32_t>(((z % kEdge) * kEdge + y % kEdge) * kEdge + x % kEdge);
  }

  Dims dims_, bricks_;
  T none_;
  std::vector<std::uint32_t> place_;
  std::vector<T> values_;
};

}  // namespace dubsar
