#pragma once
// Values at few points of a large grid: bricks of 8x8x8 points are made where somebody writes.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/system/large_pages.h"
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
    if (beyond(x, dims_.x) || beyond(y, dims_.y) || beyond(z, dims_.z)) return none_;
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
  /// Bricks that are there.
  std::size_t made() const noexcept { return values_.size() / (kEdge * kEdge * kEdge); }
  /// Room for so many bricks: none of those that are made then moves another.
  void reserve(std::size_t bricks) {
    values_.reserve(bricks * kEdge * kEdge * kEdge);
    ask_for_large_pages(values_.data() + values_.size(), (values_.capacity() - values_.size()) * sizeof(T));
  }
  /// The values of a brick, along x, then y, then z, `none` at points beyond the grid; null where there is none.
  /// Coordinates as in has_brick(), or beyond the grid.
  const T* brick(std::int64_t bx, std::int64_t by, std::int64_t bz) const noexcept {
    if (beyond(bx, bricks_.x) || beyond(by, bricks_.y) || beyond(bz, bricks_.z)) return nullptr;
    const std::uint32_t place = place_[static_cast<std::size_t>((bz * bricks_.y + by) * bricks_.x + bx)];
    return place == kNoBrick ? nullptr : values_.data() + place;
  }
  T* brick(std::int64_t bx, std::int64_t by, std::int64_t bz) noexcept {
    return const_cast<T*>(std::as_const(*this).brick(bx, by, bz));
  }
  /// Makes a brick, so that several threads may write in it. Coordinates as in has_brick().
  void add_brick(std::int64_t bx, std::int64_t by, std::int64_t bz) { at(kEdge * bx, kEdge * by, kEdge * bz) = none_; }
  /// Is there a brick at these brick coordinates (rising by one from brick to brick)?
  bool has_brick(std::int64_t bx, std::int64_t by, std::int64_t bz) const noexcept {
    return place_[static_cast<std::size_t>((bz * bricks_.y + by) * bricks_.x + bx)] != kNoBrick;
  }

 private:
  static constexpr std::uint32_t kNoBrick = 0xffffffffu;
  static bool beyond(std::int64_t at, std::int64_t end) noexcept {
    return static_cast<std::uint64_t>(at) >= static_cast<std::uint64_t>(end);
  }
  // Of points in the grid; without a sign their division is a shift.
  std::size_t brick_of(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    const auto of = [](std::int64_t at) { return static_cast<std::size_t>(at) / std::size_t{kEdge}; };
    return (of(z) * static_cast<std::size_t>(bricks_.y) + of(y)) * static_cast<std::size_t>(bricks_.x) + of(x);
  }
  static std::uint32_t inside(std::int64_t x, std::int64_t y, std::int64_t z) noexcept {
    const auto in = [](std::int64_t at) { return static_cast<std::uint32_t>(at) % std::uint32_t{kEdge}; };
    return (in(z)*std::uint32_t{kEdge} + in(y)) * std::uint32_t{kEdge} + in(x);
  }

  Dims dims_, bricks_;
  T none_;
  std::vector<std::uint32_t> place_;
  std::vector<T> values_;
};

}  // namespace dubsar
