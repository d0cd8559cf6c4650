#pragma once
// What a lens sheet and the weave of a tracked panel show where, subpixel by subpixel, in double precision. The shaders
// weave the same.

#include "display/optics/lens.h"

namespace dubsar {

/// Which view, as a real number, each subpixel shows: lens_position * views. Row 0 of the panel image is the top.
double subpixel_view(const LensSheet& sheet, int views, int column, int row_from_top, int channel) noexcept;

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

}  // namespace dubsar
