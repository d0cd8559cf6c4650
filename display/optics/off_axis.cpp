#include "display/optics/off_axis.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace dubsar {
namespace {

constexpr int kMaxScreenPx = 65535;
constexpr double kMaxScreenMm = 100000.0;
constexpr double kNearestPlaneMm = 1.0;

}  // namespace

WindowRect Screen::window_rect() const {
  const double sx = width_mm / width_px, sy = height_mm / height_px;
  const double left = window_x * sx - width_mm / 2, right = (window_x + window_w) * sx - width_mm / 2;
  const double top = height_mm / 2 - window_y * sy, bottom = height_mm / 2 - (window_y + window_h) * sy;
  return {{left, bottom, 0}, {right, bottom, 0}, {left, top, 0}};
}

Result<void> check_screen(const Screen& s) {
  const auto pixels_good = [](int n) { return n >= 1 && n <= kMaxScreenPx; };
  const auto mm_good = [](double mm) { return mm > 0 && mm <= kMaxScreenMm; };
  if (!pixels_good(s.width_px) || !pixels_good(s.height_px) || !mm_good(s.width_mm) || !mm_good(s.height_mm))
    return fail(ErrorKind::kUsage, "screen: a panel of {} x {} pixels and {} x {} mm found, expected sizes above 0",
                s.width_px, s.height_px, s.width_mm, s.height_mm);
  if (!pixels_good(s.window_w) || !pixels_good(s.window_h) || std::abs(s.window_x) > kMaxScreenPx ||
      std::abs(s.window_y) > kMaxScreenPx)
    return fail(ErrorKind::kUsage, "screen: a window of {} x {} pixels at {}, {} found, expected 1 to {} pixels a side",
                s.window_w, s.window_h, s.window_x, s.window_y, kMaxScreenPx);
  return {};
}

CameraPair camera_pair(const Observer& viewer) {
  const glm::dvec3 centre = viewer.nominal_mm + viewer.parallax_factor * (viewer.centre_mm() - viewer.nominal_mm);
  const glm::dvec3 half = 0.5 * viewer.ipd_factor * (viewer.right_mm - viewer.left_mm);
  return {centre - half, centre + half};
}

View off_axis_view(const WindowRect& window, const glm::dvec3& eye_mm, double near_mm, double far_mm) {
  const glm::dvec3 right = glm::normalize(window.lower_right - window.lower_left);
  const glm::dvec3 up = glm::normalize(window.upper_left - window.lower_left);
  const glm::dvec3 normal = glm::normalize(glm::cross(right, up));
  glm::dvec3 eye = eye_mm;
  const double found = glm::dot(eye - window.lower_left, normal);
  if (!(found >= kNearestEyeMm)) eye += (kNearestEyeMm - found) * normal;

  const glm::dvec3 a = window.lower_left - eye, b = window.lower_right - eye, c = window.upper_left - eye;
  const double scale = near_mm / -glm::dot(a, normal);
  View view;
  view.clip_from_view = glm::frustum(glm::dot(right, a) * scale, glm::dot(right, b) * scale, glm::dot(up, a) * scale,
                                     glm::dot(up, c) * scale, near_mm, far_mm);
  const glm::dvec3 axes[3] = {right, up, normal};
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) view.view_from_world[k][r] = axes[r][k];
    view.view_from_world[3][r] = -glm::dot(axes[r], eye);
  }
  return view;
}

View viewer_view(const WindowRect& window, const Observer& viewer, const glm::dvec3& eye_mm) {
  const auto screen_z = [&](double world_z) { return viewer.depth_factor * (world_z - viewer.zero_parallax_mm); };
  const double distance = std::max(eye_mm.z, kNearestEyeMm);
  const double near_mm = std::max(distance - screen_z(viewer.front_mm), kNearestPlaneMm);
  const double far_mm = std::max(distance - screen_z(viewer.back_mm), near_mm + kNearestPlaneMm);
  View view = off_axis_view(window, eye_mm, near_mm, far_mm);
  glm::dmat4 screen_from_world(1.0);
  screen_from_world[2][2] = viewer.depth_factor;
  screen_from_world[3][2] = -viewer.depth_factor * viewer.zero_parallax_mm;
  view.view_from_world = view.view_from_world * screen_from_world;
  return view;
}

std::vector<glm::dvec3> cone_eyes(int count, double cone_rad, double distance_mm, double height_mm) {
  std::vector<glm::dvec3> eyes;
  for (int i = 0; i < count; ++i) {
    const double angle = cone_rad * ((i + 0.5) / count - 0.5);
    eyes.emplace_back(distance_mm * std::tan(angle), height_mm, distance_mm);
  }
  return eyes;
}

}  // namespace dubsar
