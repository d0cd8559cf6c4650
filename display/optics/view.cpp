#include "display/optics/view.h"

namespace dubsar {

View crop_view(const View& view, int x, int y, int w, int h, int full_w, int full_h) {
  const double scale_x = static_cast<double>(full_w) / w, scale_y = static_cast<double>(full_h) / h;
  // Centre of the cropped rectangle in clip coordinates of the full picture.
  const double centre_x = (2.0 * x + w) / full_w - 1.0, centre_y = (2.0 * y + h) / full_h - 1.0;
  glm::dmat4 crop(1.0);
  crop[0][0] = scale_x;
  crop[1][1] = scale_y;
  crop[3][0] = -centre_x * scale_x;
  crop[3][1] = -centre_y * scale_y;
  return {view.view_from_world, crop * view.clip_from_view};
}

namespace {
/// -1 for the leftmost view's far edge to 1 for the rightmost's; its middle counts.
double across(int index, int count) noexcept { return (2.0 * index + 1.0) / count - 1.0; }
}  // namespace

glm::dvec2 focus_source(const ViewFocus& focus, int index, int count, const glm::dvec2& uv) noexcept {
  const glm::dvec2 zoomed = (uv - 0.5) / focus.zoom + 0.5;
  return {zoomed.x + across(index, count) * focus.focus, zoomed.y};
}

View focused_view(View view, const ViewFocus& focus, int index, int count) {
  glm::dmat4 moved(1.0);
  moved[0][0] = moved[1][1] = focus.zoom;
  moved[3][0] = -2.0 * across(index, count) * focus.focus * focus.zoom;
  view.clip_from_view = moved * view.clip_from_view;
  return view;
}

}  // namespace dubsar
