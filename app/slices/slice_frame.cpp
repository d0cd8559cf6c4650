#include "app/slices/slice_frame.h"

#include <algorithm>

namespace dubsar::app {

SliceFrame slice_frame(const ScanView& view, std::size_t which, int width, int height, double whole_mm) {
  SliceFrame out;
  out.width = width;
  out.height = height;
  out.mm_per_px = whole_mm / view.zoom / std::max(1, std::min(width, height));
  const std::array<std::array<glm::dvec3, 2>, kSlices> right_and_up{{{{{0, 1, 0}, {0, 0, 1}}},
                                                                     {{{1, 0, 0}, {0, 0, 1}}},
                                                                     {{{1, 0, 0}, {0, 1, 0}}},
                                                                     {{view.free_right, view.free_up}}}};
  out.right = right_and_up[which][0];
  out.down = -right_and_up[which][1];
  const glm::dvec3 normal = out.to_viewer();
  out.middle_mm = view.centre_mm + glm::dot(view.cursor_mm - view.centre_mm, normal) * normal;
  return out;
}

}  // namespace dubsar::app
