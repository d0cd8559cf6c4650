#pragma once
// CPU reference weaves: views to panel image, in double precision. Slow and exact; shaders are tested against them, and
// `--display` writes image files with them when no GL is there.

#include <span>

#include "core/image_io/image.h"
#include "display/optics/lens.h"

namespace dubsar {

struct WeaveOptions {
  ViewFilter filter = ViewFilter::kLinear;
  double gaussian_sigma = 0.01;  ///< of the Gaussians, in lens positions (the maker's default)
};

/// Colour 0..255 of channel k of a view at (u, v), v up: bilinear, clamped to the edge, as GL samples a texture.
double sample_channel(const Image& view, double u, double v, int channel) noexcept;
/// The same in linear light, 0..1.
double sample_light(const Image& view, double u, double v, int channel) noexcept;

/// Which view, as a real number, each subpixel shows: lens_position * views. Row 0 of the panel image is the top.
double subpixel_view(const LensSheet& sheet, int views, int column, int row_from_top, int channel) noexcept;

/// N views (0 leftmost camera, all of one size) to a panel image of sheet.width_px x height_px, RGB. Views and their
/// texels are mixed in linear light, rows dimmed by row_light() after coding. Uses all threads.
Image weave_views(std::span<const Image> views, const LensSheet& sheet, const WeaveOptions& options = {});

/// Panel geometry of a two-view weave.
struct TrackedPanel {
  LensOptics lens;
  int width_px = 0, height_px = 0;
  SubpixelLayout subpixels;
};

struct EyePair {
  glm::dvec3 left_mm{-31.5, 0.0, 600.0};
  glm::dvec3 right_mm{31.5, 0.0, 600.0};
};

/// Position on the panel, millimetres from its centre, y up, of a subpixel; row 0 is the top.
glm::dvec2 subpixel_mm(const TrackedPanel& panel, int column, int row_from_top, int channel) noexcept;

/// 0: the left eye's image, 1: the right eye's: the eye for which |phase| is smaller. Ties go to the left.
int subpixel_eye(const TrackedPanel& panel, const EyePair& eyes, const glm::dvec2& point_mm,
                 bool exact = true) noexcept;

/// Left and right image (any size) to a panel image, RGB; coded values are interpolated. `exact` = false uses the
/// paraxial shift, for comparison.
Image weave_tracked(const Image& left, const Image& right, const TrackedPanel& panel, const EyePair& eyes,
                    bool exact = true);

}  // namespace dubsar
