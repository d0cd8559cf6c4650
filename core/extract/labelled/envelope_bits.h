#pragma once
// Whose clay a grid point of clay is, the tablet's or the envelope's: one bit a point, kept only in tiles that hold
// clay of both.

#include <cstdint>
#include <vector>

#include "core/extract/bit_volume.h"

namespace dubsar {

class EnvelopeBits {
 public:
  EnvelopeBits() = default;
  /// All clay is the tablet's.
  explicit EnvelopeBits(const Dims& dims);

  const Dims& dims() const noexcept { return dims_; }
  /// Bits of 64 points of a row inside the grid (BitVolume). Nothing is said of points of air.
  std::uint64_t word(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    const std::uint32_t place = place_[tile_of(word, y, z)];
    return place == kAllTablet ? 0 : place == kAllEnvelope ? ~std::uint64_t{0} : bits_[place + row_in_tile(y, z)];
  }
  /// Not from several threads.
  void set(std::int64_t x, std::int64_t y, std::int64_t z, bool envelope);
  /// Points [begin, end) of a row are the envelope's.
  void set_run(std::int64_t begin, std::int64_t end, std::int64_t y, std::int64_t z);
  /// 64 points of a row.
  void set_word(std::int64_t word, std::int64_t y, std::int64_t z, std::uint64_t bits) {
    if (this->word(word, y, z) != bits) own_word(word, y, z) = bits;
  }
  /// Gives tiles back that have clay of one of them only, and clears the bits of air in the others: what says the same
  /// of the clay is then equal, bit by bit.
  void compact(const BitVolume& inside);

  std::size_t bytes() const noexcept { return place_.size() * sizeof place_[0] + bits_.size() * sizeof bits_[0]; }
  friend bool operator==(const EnvelopeBits&, const EnvelopeBits&) = default;

 private:
  static constexpr std::int64_t kRows = 4;  ///< a tile has so many rows of one word along y and z
  static constexpr std::uint32_t kAllTablet = 0xffffffffu, kAllEnvelope = 0xfffffffeu;

  std::size_t tile_of(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    return static_cast<std::size_t>((z / kRows * tiles_y_ + y / kRows) * words_ + word);
  }
  static std::uint32_t row_in_tile(std::int64_t y, std::int64_t z) noexcept {
    return static_cast<std::uint32_t>(z % kRows * kRows + y % kRows);
  }
  std::uint64_t& own_word(std::int64_t word, std::int64_t y, std::int64_t z);

  Dims dims_;
  std::int64_t words_ = 0, tiles_y_ = 0;
  std::vector<std::uint32_t> place_;  ///< of each tile
  std::vector<std::uint64_t> bits_;
};

}  // namespace dubsar
