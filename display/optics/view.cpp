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

}  // namespace dubsar
