#include "display/optics/lens.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {
double fract(double value) noexcept { return value - std::floor(value); }
}  // namespace

LensSheet lens_sheet(const LookingGlassFigures& figures) {
  DUBSAR_CHECK(figures.slope != 0.0 && figures.dpi > 0.0 && figures.screen_width > 0 && figures.screen_height > 0);
  LensSheet sheet;
  sheet.width_px = figures.screen_width;
  sheet.height_px = figures.screen_height;
  sheet.periods = figures.pitch * figures.screen_width / figures.dpi * std::cos(std::atan(1.0 / figures.slope));
  sheet.tilt = figures.screen_height / (figures.screen_width * figures.slope);
  sheet.centre = figures.center;
  sheet.invert_views = figures.invert_views;
  sheet.fringe = figures.fringe;
  sheet.subpixels.pattern = figures.pattern;
  if (!figures.cells.empty()) sheet.subpixels.cells = figures.cells;
  for (SubpixelCell& cell : sheet.subpixels.cells) {
    if (figures.flip_subpixels) std::swap(cell.offset_px[0], cell.offset_px[2]);
    if (figures.flip_image_x)
      for (glm::dvec2& offset : cell.offset_px) offset.x = -offset.x;
  }
  if (figures.flip_image_x) sheet.tilt = -sheet.tilt;
  return sheet;
}

int cell_index(CellPattern pattern, int cells, std::int64_t x, std::int64_t y) noexcept {
  std::int64_t index = 0;
  switch (pattern) {
    case CellPattern::kUniform:
      index = 0;
      break;
    case CellPattern::kCheckerboard:
      index = (x + y) % 2;
      break;
    case CellPattern::kColumns:
      index = x % 2;
      break;
    case CellPattern::kShiftedRows:
      index = (y + 2 * (x % 2)) % 4;
      break;
    case CellPattern::kRows:
      index = y % 2;
      break;
  }
  return static_cast<int>(index % cells);
}

glm::dvec2 SubpixelLayout::offset_px(std::int64_t x, std::int64_t y, int channel) const noexcept {
  const int cell = cell_index(pattern, static_cast<int>(cells.size()), x, y);
  return cells[static_cast<std::size_t>(cell)].offset_px[static_cast<std::size_t>(channel)];
}

double lens_position(const LensSheet& sheet, std::int64_t x, std::int64_t y, int channel) noexcept {
  const glm::dvec2 offset = sheet.subpixels.offset_px(x, y, channel);
  const double u = (static_cast<double>(x) + 0.5 + offset.x) / sheet.width_px;
  const double v = (static_cast<double>(y) + 0.5 + offset.y) / sheet.height_px;
  const double place = fract((u + v * sheet.tilt) * sheet.periods - sheet.centre);
  return sheet.invert_views ? 1.0 - place : place;
}

int nearest_view(double position, int views) noexcept {
  return std::clamp(static_cast<int>(std::floor(position * views)), 0, views - 1);
}

glm::dvec2 refraction_shift_mm(const LensOptics& lens, const glm::dvec3& eye_mm, const glm::dvec2& point_mm) noexcept {
  const glm::dvec2 to_eye{eye_mm.x - point_mm.x, eye_mm.y - point_mm.y};
  const double rho_squared = to_eye.x * to_eye.x + to_eye.y * to_eye.y;
  const double n = lens.refractive_index;
  const double slope = std::sqrt(eye_mm.z * eye_mm.z + (1.0 - 1.0 / (n * n)) * rho_squared);
  return lens.reduced_gap_mm / slope * to_eye;
}

glm::dvec2 paraxial_shift_mm(const LensOptics& lens, const glm::dvec3& eye_mm, const glm::dvec2& point_mm) noexcept {
  return lens.reduced_gap_mm / eye_mm.z * glm::dvec2{eye_mm.x - point_mm.x, eye_mm.y - point_mm.y};
}

double eye_phase(const LensOptics& lens, const glm::dvec3& eye_mm, const glm::dvec2& point_mm, bool exact) noexcept {
  const glm::dvec2 shift =
      exact ? refraction_shift_mm(lens, eye_mm, point_mm) : paraxial_shift_mm(lens, eye_mm, point_mm);
  const glm::dvec2 at_lens = point_mm + shift;
  const double phase = (at_lens.x + lens.tan_slant * at_lens.y) / lens.pitch_mm - lens.phase0;
  return phase - std::round(phase);
}

}  // namespace dubsar
