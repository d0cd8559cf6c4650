#include "display/render/images/label_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "display/render/images/utf8.h"

namespace dubsar {
namespace {

/// Distance from the outline at a place of a letter, 128 on it, as LabelFont::sheet() between its texels.
double distance_at(const LabelFont& font, const LabelFont::Glyph& glyph, double x, double y) {
  const auto texel = [&](int tx, int ty) {
    return static_cast<double>(
        font.sheet()[static_cast<std::size_t>(glyph.y + std::clamp(ty, 0, glyph.height - 1)) * LabelFont::kSide +
                     static_cast<std::size_t>(glyph.x + std::clamp(tx, 0, glyph.width - 1))]);
  };
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), across = x - 0.5 - left, down = y - 0.5 - top;
  const int tx = static_cast<int>(left), ty = static_cast<int>(top);
  return std::lerp(std::lerp(texel(tx, ty), texel(tx + 1, ty), across),
                   std::lerp(texel(tx, ty + 1), texel(tx + 1, ty + 1), across), down);
}

}  // namespace

void write_text(Image& image, LabelFont& font, std::string_view text, double x, double y, double letter_px,
                const Rgb8& ink) {
  const double scale = letter_px / LabelFont::kEmPx;
  for (const unsigned code : code_points(text)) {
    const LabelFont::Glyph glyph = font.glyph(code);
    const double left = x + scale * glyph.left, top = y - scale * glyph.top;
    for (int py = static_cast<int>(top); py <= static_cast<int>(top + scale * glyph.height); ++py)
      for (int px = static_cast<int>(left); px <= static_cast<int>(left + scale * glyph.width); ++px) {
        const double gx = (px + 0.5 - left) / scale, gy = (py + 0.5 - top) / scale;
        if (gx < 0 || gy < 0 || gx >= glyph.width || gy >= glyph.height || px < 0 || py < 0 || px >= image.width ||
            py >= image.height)
          continue;
        const double distance_px = (distance_at(font, glyph, gx, gy) - 128.0) * LabelFont::kSpreadPx / 128.0 * scale;
        const double cover = std::clamp(distance_px + 0.5, 0.0, 1.0);
        for (std::size_t c = 0; c < 3; ++c) {
          std::uint8_t& pixel = image.at(px, py)[c];
          pixel = static_cast<std::uint8_t>(std::lround((1 - cover) * pixel + cover * ink[c]));
        }
        if (image.channels == 4)
          image.at(px, py)[3] = std::max(image.at(px, py)[3], static_cast<std::uint8_t>(std::lround(255.0 * cover)));
      }
    x += scale * glyph.advance;
  }
}

Image text_block(LabelFont& font, std::span<const std::string> lines, double letter_px, const Rgb8& ground,
                 const Rgb8& ink) {
  constexpr double kLine = 1.4;  // from base line to base line, of the letters
  double widest = 0.0;
  for (const std::string& line : lines) widest = std::max(widest, font.width_em(line));
  if (lines.empty()) return {};
  Image out(static_cast<int>(std::ceil(widest * letter_px)) + 2,
            static_cast<int>(std::ceil(kLine * letter_px * static_cast<double>(lines.size()))), 3);
  for (std::size_t i = 0; i < out.pixels.size(); i += 3)
    std::copy(ground.begin(), ground.end(), out.pixels.begin() + static_cast<std::ptrdiff_t>(i));
  for (std::size_t k = 0; k < lines.size(); ++k)
    write_text(out, font, lines[k], 1.0, kLine * letter_px * (static_cast<double>(k) + 0.72), letter_px, ink);
  return out;
}

}  // namespace dubsar
