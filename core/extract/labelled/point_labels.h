#pragma once
// Labels of grid points: air, the tablet's clay, the envelope's. Air is where the signs say so; whose clay it is takes
// a second bit.

#include <cstdint>
#include <utility>

#include "core/extract/labelled/envelope_bits.h"
#include "core/extract/labelled/labelled_cell_table.h"

namespace dubsar {

class PointLabels {
 public:
  /// Keeps references to both.
  PointLabels(const BitVolume& inside, const EnvelopeBits& envelope) : inside_(&inside), envelope_(&envelope) {}

  const BitVolume& inside() const noexcept { return *inside_; }
  /// kAir beyond the grid.
  PointLabel get(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    const Dims& d = inside_->dims();
    if (x < 0 || y < 0 || z < 0 || x >= d.x || y >= d.y || z >= d.z || !inside_->get(x, y, z)) return PointLabel::kAir;
    return envelope_->word(x >> 6, y, z) >> (x & 63) & 1u ? PointLabel::kEnvelope : PointLabel::kTablet;
  }
  /// Clay of one of them in a word of a row (BitVolume); rows and words beyond the grid are 0.
  std::uint64_t envelope_word(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    return has_word(word, y, z) ? inside_->row(y, z)[word] & envelope_->word(word, y, z) : 0;
  }
  std::uint64_t tablet_word(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    return has_word(word, y, z) ? inside_->row(y, z)[word] & ~envelope_->word(word, y, z) : 0;
  }

 private:
  bool has_word(std::int64_t word, std::int64_t y, std::int64_t z) const noexcept {
    const Dims& d = inside_->dims();
    return word >= 0 && word < inside_->words_per_row() && y >= 0 && z >= 0 && y < d.y && z < d.z;
  }

  const BitVolume* inside_;
  const EnvelopeBits* envelope_;
};

}  // namespace dubsar
