#pragma once
// One bit per grid point, packed in 64-bit words along x; padding bits of each row are 0.

#include <cstdint>
#include <span>
#include <vector>

#include "core/volume/volume.h"

namespace dubsar {

class BitVolume {
 public:
  BitVolume() = default;
  explicit BitVolume(Dims dims)
      : dims_(dims),
        words_per_row_((dims.x + 63) / 64),
        words_(static_cast<std::size_t>(words_per_row_ * dims.y * dims.z)) {}

  const Dims& dims() const noexcept { return dims_; }
  std::int64_t words_per_row() const noexcept { return words_per_row_; }
  std::uint64_t* row(std::int64_t y, std::int64_t z) noexcept {
    return words_.data() + (z * dims_.y + y) * words_per_row_;
  }
  const std::uint64_t* row(std::int64_t y, std::int64_t z) const noexcept {
    return words_.data() + (z * dims_.y + y) * words_per_row_;
  }
  bool get(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    return (row(y, z)[x >> 6] >> (x & 63)) & 1u;
  }
  void set(std::int64_t x, std::int64_t y, std::int64_t z, bool value) noexcept {
    std::uint64_t& word = row(y, z)[x >> 6];
    const std::uint64_t bit = std::uint64_t{1} << (x & 63);
    word = value ? word | bit : word & ~bit;
  }
  std::span<const std::uint64_t> words() const noexcept { return words_; }
  std::span<std::uint64_t> words() noexcept { return words_; }
  friend bool operator==(const BitVolume& a, const BitVolume& b) { return a.dims_ == b.dims_ && a.words_ == b.words_; }

 private:
  Dims dims_;
  std::int64_t words_per_row_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace dubsar
