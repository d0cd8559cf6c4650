#include "core/extract/labelled/point_labels.h"

#include <algorithm>

namespace dubsar {

PointLabels::PointLabels(const BitVolume& inside)
    : inside_(&inside), words_(inside.words_per_row()), tiles_y_((inside.dims().y + kRows - 1) / kRows) {
  const std::int64_t tiles_z = (inside.dims().z + kRows - 1) / kRows;
  place_.assign(static_cast<std::size_t>(words_ * tiles_y_ * tiles_z), kAllTablet);
}

std::uint64_t& PointLabels::own_word(std::int64_t word, std::int64_t y, std::int64_t z) {
  std::uint32_t& place = place_[tile_of(word, y, z)];
  if (place >= kAllEnvelope) {
    const std::uint64_t all = place == kAllEnvelope ? ~std::uint64_t{0} : 0;
    place = static_cast<std::uint32_t>(bits_.size());
    bits_.resize(bits_.size() + kRows * kRows, all);
  }
  return bits_[place + row_in_tile(y, z)];
}

void PointLabels::set_envelope(std::int64_t x, std::int64_t y, std::int64_t z, bool envelope) {
  const std::uint64_t bit = std::uint64_t{1} << (x & 63);
  if (((envelope_bits(x >> 6, y, z) & bit) != 0) == envelope) return;
  std::uint64_t& word = own_word(x >> 6, y, z);
  word = envelope ? word | bit : word & ~bit;
}

void PointLabels::set_envelope_run(std::int64_t begin, std::int64_t end, std::int64_t y, std::int64_t z) {
  for (std::int64_t x = begin; x < end;) {
    const std::int64_t stop = std::min(end, (x | 63) + 1);
    const std::uint64_t mask = (stop - x == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << (stop - x)) - 1) << (x & 63);
    if ((envelope_bits(x >> 6, y, z) & mask) != mask) own_word(x >> 6, y, z) |= mask;
    x = stop;
  }
}

void PointLabels::compact() {
  std::vector<std::uint64_t> kept;
  const std::int64_t tiles_z = (inside_->dims().z + kRows - 1) / kRows;
  for (std::int64_t tz = 0; tz < tiles_z; ++tz)
    for (std::int64_t ty = 0; ty < tiles_y_; ++ty)
      for (std::int64_t w = 0; w < words_; ++w) {
        std::uint32_t& place = place_[tile_of(w, kRows * ty, kRows * tz)];
        if (place >= kAllEnvelope) continue;
        std::uint64_t tablet = 0, envelope = 0;
        for (std::int64_t z = kRows * tz; z < kRows * (tz + 1); ++z)
          for (std::int64_t y = kRows * ty; y < kRows * (ty + 1); ++y) {
            tablet |= tablet_word(w, y, z);
            envelope |= envelope_word(w, y, z);
          }
        const auto from = bits_.begin() + place;
        if (envelope == 0) {
          place = kAllTablet;
        } else if (tablet == 0) {
          place = kAllEnvelope;
        } else {
          place = static_cast<std::uint32_t>(kept.size());
          kept.insert(kept.end(), from, from + kRows * kRows);
        }
      }
  bits_ = std::move(kept);
}

}  // namespace dubsar
