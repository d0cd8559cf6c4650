#include "core/extract/point_labels.h"

namespace dubsar {

PointLabels::PointLabels(const BitVolume& inside)
    : inside_(&inside), words_(inside.words_per_row()), tiles_y_((inside.dims().y + kRows - 1) / kRows) {
  const std::int64_t tiles_z = (inside.dims().z + kRows - 1) / kRows;
  place_.assign(static_cast<std::size_t>(words_ * tiles_y_ * tiles_z), kAllTablet);
}

void PointLabels::set_envelope(std::int64_t x, std::int64_t y, std::int64_t z, bool envelope) {
  std::uint32_t& place = place_[tile_of(x >> 6, y, z)];
  if (place >= kAllEnvelope) {
    const bool all = place == kAllEnvelope;
    if (all == envelope) return;
    place = static_cast<std::uint32_t>(bits_.size());
    bits_.resize(bits_.size() + kRows * kRows, all ? ~std::uint64_t{0} : 0);
  }
  std::uint64_t& word = bits_[place + row_in_tile(y, z)];
  const std::uint64_t bit = std::uint64_t{1} << (x & 63);
  word = envelope ? word | bit : word & ~bit;
}

}  // namespace dubsar
