#pragma once
// An 8-bit picture in memory: rows from top to bottom, RGB or RGBA interleaved.

#include <cstdint>
#include <vector>

namespace dubsar {

struct Image {
  int width = 0, height = 0;
  int channels = 4;  ///< 3 or 4
  std::vector<std::uint8_t> pixels;

  Image() = default;
  Image(int w, int h, int c = 4) : width(w), height(h), channels(c), pixels(static_cast<std::size_t>(w) * h * c) {}
  std::uint8_t* at(int x, int y) noexcept {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
  const std::uint8_t* at(int x, int y) const noexcept {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

}  // namespace dubsar
