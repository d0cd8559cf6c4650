#include "core/extract/labelled/envelope_bits.h"

#include <algorithm>

namespace dubsar {

EnvelopeBits::EnvelopeBits(const Dims& dims)
    : dims_(dims), words_((dims.x + 63) / 64), tiles_y_((dims.y + kRows - 1) / kRows) {
  const std::int64_t tiles_z = (dims.z + kRows - 1) / kRows;
  place_.assign(static_cast<std::size_t>(words_ * tiles_y_ * tiles_z), kAllTablet);
}

std::uint64_t& EnvelopeBits::own_word(std::int64_t word, std::int64_t y, std::int64_t z) {
  std::uint32_t& place = place_[tile_of(word, y, z)];
  if (place >= kAllEnvelope) {
    const std::uint64_t all = place == kAllEnvelope ? ~std::uint64_t{0} : 0;
    place = static_cast<std::uint32_t>(bits_.size());
    bits_.resize(bits_.size() + kRows * kRows, all);
  }
  return bits_[place + row_in_tile(y, z)];
}

void EnvelopeBits::set(std::int64_t x, std::int64_t y, std::int64_t z, bool envelope) {
  const std::uint64_t bit = std::uint64_t{1} << (x & 63);
  if (((word(x >> 6, y, z) & bit) != 0) == envelope) return;
  std::uint64_t& own = own_word(x >> 6, y, z);
  own = envelope ? own | bit : own & ~bit;
}

void EnvelopeBits::set_run(std::int64_t begin, std::int64_t end, std::int64_t y, std::int64_t z) {
  for (std::int64_t x = begin; x < end;) {
    const std::int64_t stop = std::min(end, (x | 63) + 1);
    const std::uint64_t mask = (stop - x == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << (stop - x)) - 1) << (x & 63);
    if ((word(x >> 6, y, z) & mask) != mask) own_word(x >> 6, y, z) |= mask;
    x = stop;
  }
}

void EnvelopeBits::compact(const BitVolume& inside) {
  std::vector<std::uint64_t> kept;
  const std::int64_t tiles_z = (dims_.z + kRows - 1) / kRows;
  for (std::int64_t tz = 0; tz < tiles_z; ++tz)
    for (std::int64_t ty = 0; ty < tiles_y_; ++ty)
      for (std::int64_t w = 0; w < words_; ++w) {
        std::uint32_t& place = place_[tile_of(w, kRows * ty, kRows * tz)];
        if (place == kAllTablet) continue;
        std::uint64_t tablet = 0, envelope = 0;
        const std::size_t first = kept.size();
        kept.resize(first + kRows * kRows, 0);
        for (std::int64_t z = kRows * tz; z < std::min(kRows * (tz + 1), dims_.z); ++z)
          for (std::int64_t y = kRows * ty; y < std::min(kRows * (ty + 1), dims_.y); ++y) {
            const std::uint64_t clay = inside.row(y, z)[w], own = word(w, y, z) & clay;
            tablet |= clay & ~own;
            envelope |= own;
            kept[first + row_in_tile(y, z)] = own;
          }
        if (tablet != 0 && envelope != 0) {
          place = static_cast<std::uint32_t>(first);
          continue;
        }
        place = envelope != 0 ? kAllEnvelope : kAllTablet;
        kept.resize(first);
      }
  bits_ = std::move(kept);
}

}  // namespace dubsar
