#pragma once
// What the sinks draw, computed pixel by pixel in double precision: slow and exact. Shaders are tested against these.

#include <span>
#include <vector>

#include "core/image_io/image.h"
#include "display/optics/weave.h"
#include "display/sinks/anaglyph.h"
#include "display/sinks/interlaced.h"
#include "display/sinks/packed.h"
#include "display/sinks/quilt.h"

namespace dubsar::testing {

/// What the coded colours of a row of pixels are multiplied with, y from the bottom (LensSheet::fringe).
double row_light(const LensSheet& sheet, std::int64_t y) noexcept;

struct ViewWeight {
  int view;
  double weight;
};

/// Views that make up a subpixel at a place 0..1 across its lens, and their weights (sum 1); at the ends the views
/// there are. `sigma` is the Gaussians' width in places across the lens.
std::vector<ViewWeight> view_weights(double position, int views, ViewFilter filter, double sigma = kViewSigma);

struct WeaveOptions {
  ViewFilter filter = ViewFilter::kLinear;
  double gaussian_sigma = kViewSigma;
};

/// N views (0 leftmost camera, all of one size) to a panel image of sheet.width_px x height_px, RGB. Views and their
/// texels are mixed in linear light, rows dimmed by row_light() after coding.
Image weave_views(std::span<const Image> views, const LensSheet& sheet, const WeaveOptions& options = {});

/// Left and right image (any size) to a panel image, RGB; coded values are interpolated.
Image weave_tracked(const Image& left, const Image& right, const TrackedPanel& panel, const EyePair& eyes);

/// Mixed in linear light.
Image anaglyph_views(const Image& left, const Image& right, const AnaglyphVariant& variant);

/// 0: the even place, 1: the odd one, for channel k of the panel pixel (x, y), counted from the panel's upper left.
int interlace_parity(InterlacePattern pattern, int panel_x, int panel_y, int channel) noexcept;

/// Both views have the window's size.
Image interlace_views(const Image& left, const Image& right, const Screen& screen, InterlacePattern pattern,
                      bool right_first);

Image pack_views(const Image& left, const Image& right, PixelSize window, const Packing& packing);

/// layout.views() pictures of the tile's size.
Image make_quilt(std::span<const Image> views, const QuiltLayout& layout);

}  // namespace dubsar::testing
