#pragma once
// A webcam's lens and place: from pixels and depths to the screen frame.

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "core/base/numbers/pose.h"

namespace dubsar {

/// A camera that looks at the person before the screen. Its own frame: origin in the lens, +Z out of it, +Y
/// up, +X to the right as the person sees it, so that an untilted camera has the screen's axes; its picture
/// is not mirrored, hence pixels to the right are -X.
struct CameraView {
  double horizontal_field_rad = std::numbers::pi / 3.0;  ///< of the picture's width
  glm::dvec3 at_m{0.0};                                  ///< the lens in the screen frame
  double tilt_rad = 0.0;                                 ///< positive: looks down

  double focal_px(int width) const noexcept { return 0.5 * width / std::tan(0.5 * horizontal_field_rad); }

  /// Camera frame, metres; `depth_m` along the camera's axis.
  glm::dvec3 point_m(const glm::dvec2& pixel, int width, int height, double depth_m) const noexcept {
    const double f = focal_px(width);
    return {-(pixel.x - 0.5 * width) * depth_m / f, -(pixel.y - 0.5 * height) * depth_m / f, depth_m};
  }
  Pose screen_from_camera() const noexcept { return {at_m, glm::angleAxis(tilt_rad, glm::dvec3(1.0, 0.0, 0.0))}; }
};

}  // namespace dubsar
