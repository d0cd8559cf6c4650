#include "display/sinks/stereo_views.h"

namespace dubsar {

std::array<View, 2> stereo_views(const Screen& screen, const Viewer& viewer) {
  const WindowRect window = screen.window_rect();
  const CameraPair cameras = camera_pair(viewer);
  return {viewer_view(window, viewer, cameras.left_mm), viewer_view(window, viewer, cameras.right_mm)};
}

}  // namespace dubsar
