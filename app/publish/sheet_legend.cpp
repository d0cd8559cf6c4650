#include "app/publish/sheet_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/base/numbers/inch.h"
#include "display/render/images/legend_image.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar::app {
namespace {

constexpr double kLetterMm = 2.5;
constexpr int kLeastLetterPx = 8;

/// What there is to tell, each as a picture; a picture of no style's colours only takes its room.
Result<std::vector<Image>> blocks(const Style& style, const SheetLegend& legend, int letter_px, const LegendInk& ink) {
  std::vector<Image> out;
  if (is_field(style.map)) {
    DUBSAR_ASSIGN(Image figure, legend_image(style, *legend.font, letter_px, ink));
    out.push_back(std::move(figure));
  } else if (legend.figure_room) {
    Style other = style;
    other.map = ColorMap::kIntegral;
    DUBSAR_ASSIGN(const Image figure, legend_image(other, *legend.font, letter_px, ink));
    Image empty(figure.width, figure.height, 3);
    for (std::size_t i = 0; i < empty.pixels.size(); ++i) empty.pixels[i] = ink.ground[i % 3];
    out.push_back(std::move(empty));
  }
  if (style.mark_inferred && legend.inferred_mm2 > 0)
    out.push_back(evidence_legend(
        style,
        fmt::format("{:.1f} mm\u00b2, {:.1f} % of the surface", legend.inferred_mm2, 100 * legend.inferred_share),
        *legend.font, letter_px, ink));
  return out;
}

int widest(const std::vector<Image>& images) {
  int out = 0;
  for (const Image& image : images) out = std::max(out, image.width);
  return out;
}

}  // namespace

Result<Image> draw_sheet_legend(const Style& style, const SheetLegend& legend, double dpi, int most_width,
                                const Rgb8& ground) {
  if (legend.font == nullptr) return Image();
  const bool dark = ground[0] + ground[1] + ground[2] < 384;
  const LegendInk ink{ground, dark ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0}};
  const int wanted = std::max(kLeastLetterPx, static_cast<int>(std::lround(kLetterMm / kMmPerInch * dpi)));
  DUBSAR_ASSIGN(std::vector<Image> found, blocks(style, legend, wanted, ink));
  if (found.empty()) return Image();
  if (const int width = widest(found); width > most_width) {
    const int smaller = std::max(kLeastLetterPx, wanted * most_width / width);
    DUBSAR_ASSIGN(found, blocks(style, legend, smaller, ink));
  }
  int height = 0;
  for (const Image& image : found) height += image.height;
  Image out(widest(found), height, 3);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = ground[i % 3];
  int y = 0;
  for (const Image& image : found) {
    const int x = (out.width - image.width) / 2;
    for (int row = 0; row < image.height; ++row)
      std::memcpy(out.at(x, y + row), image.at(0, row), static_cast<std::size_t>(image.width) * 3);
    y += image.height;
  }
  return out;
}

}  // namespace dubsar::app
