#include "display/render/images/test_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace dubsar {
namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kGlyphStep = 6;
// Rows from the top, five bits each, the leftmost pixel in bit 4.
constexpr std::array<std::array<std::uint8_t, kGlyphHeight>, 10> kDigits{{{14, 17, 19, 21, 25, 17, 14},
                                                                          {4, 12, 4, 4, 4, 4, 14},
                                                                          {14, 17, 1, 2, 4, 8, 31},
                                                                          {31, 2, 4, 2, 1, 17, 14},
                                                                          {2, 6, 10, 18, 31, 2, 2},
                                                                          {31, 16, 30, 1, 1, 17, 14},
                                                                          {6, 8, 16, 30, 17, 17, 14},
                                                                          {31, 1, 2, 4, 8, 8, 8},
                                                                          {14, 17, 17, 14, 17, 17, 14},
                                                                          {14, 17, 17, 15, 1, 2, 12}}};
constexpr Rgb8 kInk{255, 255, 255};

void fill(Image& image, int left, int top, int width, int height, const Rgb8& color) {
  for (int y = std::max(0, top); y < std::min(image.height, top + height); ++y)
    for (int x = std::max(0, left); x < std::min(image.width, left + width); ++x)
      std::copy_n(color.data(), 3, image.at(x, y));
}

/// The number with its middle at (x, y), `scale` pixels a dot.
void write_number(Image& image, int number, int x, int y, int scale) {
  const std::string text = std::to_string(number);
  int left = x - (static_cast<int>(text.size()) * kGlyphStep - 1) * scale / 2;
  const int top = y - kGlyphHeight * scale / 2;
  for (const char c : text) {
    const auto& glyph = kDigits[static_cast<std::size_t>(c - '0')];
    for (int row = 0; row < kGlyphHeight; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        if (glyph[static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - column) & 1)
          fill(image, left + column * scale, top + row * scale, scale, scale, kInk);
    left += kGlyphStep * scale;
  }
}

}  // namespace

Rgb8 pattern_color(int index, int count) {
  const double hue = 6.0 * index / std::max(1, count);
  Rgb8 color{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double distance = std::abs(std::remainder(hue - 2.0 * static_cast<double>(c), 6.0));
    color[c] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(2.0 - distance, 0.0, 1.0)));
  }
  return color;
}

Image numbered_view(int width, int height, int index, int count) {
  Image image(width, height, 4);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{255});
  const int side = std::min(width, height), line = std::max(1, side / 150);
  Rgb8 ground = pattern_color(index, count);
  for (std::uint8_t& value : ground) value = static_cast<std::uint8_t>(value / 2);
  fill(image, line, line, width - 2 * line, height - 2 * line, ground);
  fill(image, (width - line) / 2, 0, line, height, kInk);
  const int large = std::max(1, side / (3 * kGlyphHeight)), small = std::max(1, side / (10 * kGlyphHeight));
  fill(image, width / 2 - 10 * large, height / 2 - 5 * large, 20 * large, 10 * large, ground);
  write_number(image, index, width / 2, height / 2, large);
  const int inset_x = 12 * small, inset_y = 8 * small;
  for (const int x : {inset_x, width - inset_x})
    for (const int y : {inset_y, height - inset_y}) write_number(image, index, x, y, small);
  return image;
}

}  // namespace dubsar
