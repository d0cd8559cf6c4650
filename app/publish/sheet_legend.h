#pragma once
// What stands below a printed sheet: the scale of colours that tell a figure, and what is hatched.

#include "core/base/result.h"
#include "core/image_io/image.h"
#include "display/render/images/label_font.h"
#include "display/render/shading.h"

namespace dubsar::app {

struct SheetLegend {
  LabelFont* font = nullptr;                        ///< null: no legend
  double inferred_mm2 = 0.0, inferred_share = 0.0;  ///< of the surface: what the scan does not show; share: 0..1
  bool figure_room = false;  ///< as high as if the style told a figure, so that sheets of several styles are alike
};

/// RGB on `ground`, letters 2.5 mm high at `dpi`, smaller where it would be wider than `most_width`; a picture without
/// pixels when there is nothing to tell. Errors of legend_image().
Result<Image> draw_sheet_legend(const Style& style, const SheetLegend& legend, double dpi, int most_width,
                                const Rgb8& ground);

}  // namespace dubsar::app
