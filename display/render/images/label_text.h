#pragma once
// Letters in pictures that are made without GL's help: rulers, legends, captions.

#include <span>
#include <string>
#include <string_view>

#include "core/image_io/image.h"
#include "display/render/images/label_font.h"
#include "display/render/shading.h"

namespace dubsar {

/// Text in UTF-8 whose base line begins at x, y (pixels, y down), blended into a picture of 3 or 4 channels; what lies
/// beyond its sides is left out. `letter_px`: height that the font is set in.
void write_text(Image& image, LabelFont& font, std::string_view text, double x, double y, double letter_px,
                const Rgb8& ink);

/// Lines below each other, as wide as the longest one; RGB. No lines: a picture without pixels.
Image text_block(LabelFont& font, std::span<const std::string> lines, double letter_px, const Rgb8& ground,
                 const Rgb8& ink);

}  // namespace dubsar
