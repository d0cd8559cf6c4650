#pragma once
// Off-axis cameras: the panel is a window, the eye looks through it (generalised perspective projection, Kooima 2009).
// Screen frame: millimetres, panel centre, +X right, +Y up, +Z to the viewer. Pure maths.

#include <glm/vec3.hpp>
#include <vector>

#include "core/base/result.h"
#include "display/optics/view.h"

namespace dubsar {

/// A rectangle that light comes through, by three of its corners; it may stand anywhere in space.
struct WindowRect {
  glm::dvec3 lower_left, lower_right, upper_left;
};

/// A panel and the part of it that we draw on. Pixels count from the panel's upper left corner.
struct Screen {
  double width_mm = 344.0, height_mm = 194.0;  ///< of the whole panel
  int width_px = 1920, height_px = 1080;       ///< of the whole panel
  int window_x = 0, window_y = 0;              ///< where our window's drawing area starts on the panel
  int window_w = 1920, window_h = 1080;        ///< its size in physical pixels

  /// Our window in the screen frame.
  WindowRect window_rect() const;
  friend bool operator==(const Screen&, const Screen&) = default;
};

/// kUsage unless sizes are positive and sane and the window has at least one pixel; it may reach over the panel's edge.
Result<void> check_screen(const Screen& screen);

/// Who looks, and how deep the picture shall be.
struct Observer {
  glm::dvec3 left_mm{-31.5, 0.0, 600.0};  ///< eyes in the screen frame
  glm::dvec3 right_mm{31.5, 0.0, 600.0};
  glm::dvec3 nominal_mm{0.0, 0.0, 600.0};  ///< where the viewer is expected; centre for parallax_factor
  double ipd_factor = 1.0;                 ///< scales the eyes' distance about their centre; 0: both see the same
  double parallax_factor = 1.0;            ///< 1: full look-around, 0: the head's place does not matter
  double depth_factor = 1.0;               ///< scales the scene's depth about the panel
  double zero_parallax_mm = 0.0;           ///< world z that appears in the panel's plane
  double front_mm = 300.0;                 ///< world z of the nearest and the farthest thing to show
  double back_mm = -600.0;
  bool swap_eyes = false;  ///< two views: each eye gets the other's; glasses worn or wired wrongly

  glm::dvec3 centre_mm() const { return 0.5 * (left_mm + right_mm); }
};

/// The viewer's eyes after ipd_factor and parallax_factor: the places cameras stand at.
struct CameraPair {
  glm::dvec3 left_mm, right_mm;
  glm::dvec3 centre_mm() const { return 0.5 * (left_mm + right_mm); }
};
CameraPair camera_pair(const Observer& viewer);

constexpr double kNearestEyeMm = 20.0;  ///< an eye nearer to the window's plane, or behind it, is moved here

/// The view of `eye_mm` through `window`, near and far planes at these distances from the eye (far > near > 0). A point
/// in the window's plane is seen at the same place by every eye.
View off_axis_view(const WindowRect& window, const glm::dvec3& eye_mm, double near_mm, double far_mm);

/// The same for a viewer's scene: clip planes around front_mm and back_mm, depth factor and zero-parallax plane
/// applied.
View viewer_view(const WindowRect& window, const Observer& viewer, const glm::dvec3& eye_mm);

/// Eyes of an N-view panel: camera i looks from angle cone * ((i + 1/2) / count - 1/2) off the normal at `distance_mm`,
/// all at the same height, 0 leftmost. That is the middle of the bin that a lens of `count` views shows. Looking Glass
/// cameras are this case: off = distance * tan(angle).
std::vector<glm::dvec3> cone_eyes(int count, double cone_rad, double distance_mm, double height_mm = 0.0);

}  // namespace dubsar
