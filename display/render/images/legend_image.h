#pragma once
// The legend of a style whose colours tell a figure of the surface, as a picture of its own to be put into another one.

#include <string>

#include "core/base/result.h"
#include "core/image_io/image.h"
#include "display/render/images/label_font.h"
#include "display/render/shading.h"

namespace dubsar {

constexpr int kLegendTicks = 5;  ///< numbers at the bar: its ends, its middle, and between them

/// Three significant digits at most, without a minus before 0.
std::string legend_number(double value);

struct LegendInk {
  Rgb8 ground{31, 33, 37}, letters{232, 228, 220};
};

/// RGB: name and unit, a bar of the colours, and its numbers, with letters of `letter_px`. kUsage for styles whose
/// colours tell no figure.
Result<Image> legend_image(const Style& style, LabelFont& font, int letter_px, const LegendInk& ink = {});

/// RGB: what the hatch of a style means, and `figures` about it.
Image evidence_legend(const Style& style, const std::string& figures, LabelFont& font, int letter_px,
                      const LegendInk& ink = {});

/// Puts a picture into the lower left corner of another one of 3 or 4 channels, as far as it fits.
void put_into_corner(const Image& what, Image& into, int margin_px);

}  // namespace dubsar
