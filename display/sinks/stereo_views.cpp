#include "display/sinks/stereo_views.h"

#include <utility>

namespace dubsar {

std::array<View, 2> stereo_views(const Screen& screen, const Observer& viewer) {
  const WindowRect window = screen.window_rect();
  const CameraPair cameras = camera_pair(viewer);
  std::array<View, 2> views{viewer_view(window, viewer, cameras.left_mm),
                            viewer_view(window, viewer, cameras.right_mm)};
  if (viewer.swap_eyes) std::swap(views[0], views[1]);
  return views;
}

}  // namespace dubsar
