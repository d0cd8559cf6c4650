#include "core/exa/offsets/offset_window.h"

#include <algorithm>

namespace dubsar {

BrickSigns::BrickSigns(const BitVolume& signs, const std::array<std::int64_t, 3>& low) {
  const Dims& d = signs.dims();
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z};
  for (std::size_t a = 0; a < 3; ++a) points_[a] = static_cast<int>(std::min<std::int64_t>(129, size[a] - low[a]));
  bytes_.assign(static_cast<std::size_t>((points_[2] + 2 * kBorder) * (points_[1] + 2 * kBorder) * kRowBytes), 0);
  std::size_t at = 0;
  for (int z = -kBorder; z < points_[2] + kBorder; ++z)
    for (int y = -kBorder; y < points_[1] + kBorder; ++y, at += kRowBytes) {
      const std::uint64_t* from =
          signs.row(low[1] + std::clamp(y, 0, points_[1] - 1), low[2] + std::clamp(z, 0, points_[2] - 1)) + low[0] / 64;
      unsigned char* to = bytes_.data() + at;
      std::memcpy(to + 1, from, static_cast<std::size_t>((points_[0] + 63) / 64) * 8);
      const int end = points_[0] + 8;
      const bool first = to[1] & 1, last = to[(end - 1) >> 3] >> ((end - 1) & 7) & 1;
      to[0] = first ? 255 : 0;
      for (int bit = end; bit < end + 8; ++bit) {
        const auto mask = static_cast<unsigned char>(1u << (bit & 7));
        to[bit >> 3] = static_cast<unsigned char>(last ? to[bit >> 3] | mask : to[bit >> 3] & ~mask);
      }
    }
}

OffsetWindow::OffsetWindow(const BrickSigns& signs)
    : signs_(signs), known_(static_cast<std::size_t>(4 * 3 * kRows * OffsetPlace::kKnownRow) + 64, 0) {}

void OffsetWindow::begin_slice(int z) {
  for (int axis = 0; axis < 3; ++axis) {
    auto& written = written_[slot(axis, z)];
    for (std::size_t y = 0; y < written.size(); ++y) {
      if (written[y] == 0) continue;
      written[y] = 0;
      std::fill_n(known_.begin() + index(axis, static_cast<int>(y), z), 129, std::uint8_t{0});
    }
  }
}

OffsetPlace OffsetWindow::place(int y, int z) const noexcept {
  OffsetPlace place;
  place.signs = signs_.row(y, z);
  place.sign_plane = signs_.plane_bytes();
  for (int axis = 0; axis < 3; ++axis)
    for (int back = 0; back < 3; ++back)
      place.known[static_cast<std::size_t>(axis)][static_cast<std::size_t>(2 - back)] =
          known_.data() + index(axis, y, z - back);
  return place;
}

}  // namespace dubsar
