#include "display/optics/weave.h"

#include <cmath>

namespace dubsar {

double subpixel_view(const LensSheet& sheet, int views, int column, int row_from_top, int channel) noexcept {
  return lens_position(sheet, column, sheet.height_px - 1 - row_from_top, channel) * views;
}

glm::dvec2 subpixel_mm(const TrackedPanel& panel, int column, int row_from_top, int channel) noexcept {
  const glm::dvec2 offset = panel.subpixels.offset_px(column, panel.height_px - 1 - row_from_top, channel);
  return {(column + 0.5 + offset.x - 0.5 * panel.width_px) * panel.lens.pixel_mm.x,
          (0.5 * panel.height_px - row_from_top - 0.5 + offset.y) * panel.lens.pixel_mm.y};
}

int subpixel_eye(const TrackedPanel& panel, const EyePair& eyes, const glm::dvec2& point_mm, bool exact) noexcept {
  const double left = std::abs(eye_phase(panel.lens, eyes.left_mm, point_mm, exact));
  const double right = std::abs(eye_phase(panel.lens, eyes.right_mm, point_mm, exact));
  return right < left ? 1 : 0;
}

}  // namespace dubsar
