#pragma once
// Labels of grid points: air, the tablet's clay, the envelope's. Air is where the signs say so; whose clay it is takes
// a second bit, which is kept only in tiles that hold clay of both.

#include <cstdint>
#include <vector>

#include "core/extract/bit_volume.h"
#include "core/extract/labelled/labelled_cell_table.h"

namespace dubsar {

class PointLabels {
 public:
  /// All clay is the tablet's. Keeps a reference to `inside`.
  explicit PointLabels(const BitVolume& inside);

  const BitVolume& inside() const noexcept { return *inside_; }
  /// kAir beyond the grid.
  PointLabel get(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    const Dims& d = inside_->dims();
    if (x < 0 || y < 0 || z < 0 || x >= d.x || y >= d.y || z >= d.z || !inside_->get(x, y, z)) return PointLabel::kAir;
    return envelope_bits(x >> 6, y, z) >> (x & 63) & 1u ? PointLabel::kEnvelope : PointLabel::kTablet;
  }
  /// Of a point of the grid; nothing is seen of it where there is air. Not from several threads.
  void set_envelope(std::int64_t x, std::int64_t y, std::int64_t z, bool envelope);
  /// Points [begin, end) of a row are the envelope's.
  void set_envelope_run(std::int64_t begin, std::int64_t end, std::int64_t y, std::int64_t z);
  /// Gives tiles back that have clay of one of them only.
  void compact();

  /// Clay of one of them in a word of a row (BitVolume); rows and words beyond the grid are 0.
  std::uint64_t envelope_word(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    return has_word(word, y, z) ? inside_->row(y, z)[word] & envelope_bits(word, y, z) : 0;
  }
  std::uint64_t tablet_word(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    return has_word(word, y, z) ? inside_->row(y, z)[word] & ~envelope_bits(word, y, z) : 0;
  }
  /// Bytes beside the signs.
  std::size_t bytes() const noexcept { return place_.size() * sizeof place_[0] + bits_.size() * sizeof bits_[0]; }

 private:
  static constexpr std::int64_t kRows = 4;  ///< a tile has so many rows of one word along y and z
  static constexpr std::uint32_t kAllTablet = 0xffffffffu, kAllEnvelope = 0xfffffffeu;

  bool has_word(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    const Dims& d = inside_->dims();
    return word >= 0 && word < words_ && y >= 0 && z >= 0 && y < d.y && z < d.z;
  }
  std::size_t tile_of(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    return static_cast<std::size_t>((z / kRows * tiles_y_ + y / kRows) * words_ + word);
  }
  static std::uint32_t row_in_tile(std::int64_t y, std::int64_t z) noexcept {
    return static_cast<std::uint32_t>(z % kRows * kRows + y % kRows);
  }
  std::uint64_t envelope_bits(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    const std::uint32_t place = place_[tile_of(word, y, z)];
    return place == kAllTablet ? 0 : place == kAllEnvelope ? ~std::uint64_t{0} : bits_[place + row_in_tile(y, z)];
  }

  std::uint64_t& own_word(std::int64_t word, std::int64_t y, std::int64_t z);

  const BitVolume* inside_;
  std::int64_t words_ = 0, tiles_y_ = 0;
  std::vector<std::uint32_t> place_;  ///< of each tile
  std::vector<std::uint64_t> bits_;
};

}  // namespace dubsar
