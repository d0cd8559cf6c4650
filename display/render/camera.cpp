#include "display/render/camera.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <string>
#include <utility>

namespace dubsar {
namespace {

constexpr int kMaxPictureSide = 65535;
constexpr double kDepthMargin = 0.01;  // of the box diagonal, before the nearest and behind the farthest point

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }
// Exact for the named views, so that front and back show the same pixels mirrored.
double cos_deg(double degrees) {
  const double turn = std::fmod(std::abs(degrees), 360.0);
  if (turn == 90.0 || turn == 270.0) return 0.0;
  return std::cos(radians(turn));
}
double sin_deg(double degrees) { return cos_deg(degrees - 90.0); }

std::array<glm::dvec3, 8> corners(const Box& box) {
  std::array<glm::dvec3, 8> out;
  for (int i = 0; i < 8; ++i) out[i] = box.corner(i);
  return out;
}

}  // namespace

ObjectFrame object_frame(const Box& box) {
  const glm::dvec3 s = box.size();
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  if (s.z <= s.x && s.z <= s.y) return {x, y, z};
  if (s.y <= s.x) return {x, z, -y};
  return {y, z, x};
}

ObjectFrame picture_frame(const ObjectFrame& object, const ViewDirection& d) {
  const double ca = cos_deg(d.azimuth_deg), sa = sin_deg(d.azimuth_deg);
  const double ce = cos_deg(d.elevation_deg), se = sin_deg(d.elevation_deg);
  const glm::dvec3 level = ca * object.front + sa * object.right;
  const glm::dvec3 back = ce * level + se * object.up;
  const glm::dvec3 up = ce * object.up - se * level;
  const glm::dvec3 right = ca * object.right - sa * object.front;
  const double cr = cos_deg(d.roll_deg), sr = sin_deg(d.roll_deg);
  return {cr * right + sr * up, cr * up - sr * right, back};
}

Result<ViewDirection> parse_view_direction(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, ViewDirection>, 6> kNamed{{{"front", {0, 0, 0}},
                                                                              {"back", {180, 0, 0}},
                                                                              {"left", {-90, 0, 0}},
                                                                              {"right", {90, 0, 0}},
                                                                              {"top", {0, 90, 0}},
                                                                              {"bottom", {0, -90, 0}}}};
  for (const auto& [name, direction] : kNamed)
    if (text == name) return direction;
  constexpr std::string_view kOrbit = "orbit:";
  std::array<double, 3> numbers{};
  if (text.starts_with(kOrbit)) {
    const char* at = text.data() + kOrbit.size();
    const char* const end = text.data() + text.size();
    for (std::size_t count = 0; count < numbers.size(); ++count) {
      const auto [next, error] = std::from_chars(at, end, numbers[count]);
      if (error != std::errc() || !std::isfinite(numbers[count]) || std::abs(numbers[count]) > 36000) break;
      if (next == end && count > 0) return ViewDirection{numbers[0], numbers[1], numbers[2]};
      if (next == end || *next != ',') break;
      at = next + 1;
    }
  }
  return fail(ErrorKind::kUsage,
              "view \"{}\" is not known, expected front, back, left, right, top, bottom or "
              "orbit:AZIMUTH,ELEVATION[,ROLL] in degrees",
              text);
}

Result<Camera> fit_camera(const Box& box, const CameraOptions& options) {
  const glm::dvec3 size = box.size();
  const double diagonal = glm::length(size);
  if (!std::isfinite(diagonal) || !(diagonal > 0) || size.x < 0 || size.y < 0 || size.z < 0)
    return fail(ErrorKind::kUsage, "camera: the object has no extent, expected at least one triangle to show");
  if (!(options.margin >= 0 && options.margin <= 0.45))
    return fail(ErrorKind::kUsage, "camera: margin {} found, expected 0 to 0.45", options.margin);
  if (!(options.mm_per_pixel >= 0) || !std::isfinite(options.mm_per_pixel))
    return fail(ErrorKind::kUsage, "camera: {} mm per pixel found, expected more than 0", options.mm_per_pixel);
  if (options.perspective && options.mm_per_pixel > 0)
    return fail(ErrorKind::kUsage, "camera: a perspective view has no scale in mm per pixel; use an orthographic one");
  if (options.perspective && !(options.field_of_view_deg >= 1 && options.field_of_view_deg <= 120))
    return fail(ErrorKind::kUsage, "camera: field of view {} degrees found, expected 1 to 120",
                options.field_of_view_deg);

  const ObjectFrame axes = picture_frame(options.object.value_or(object_frame(box)), options.direction);
  const glm::dvec3 centre = box.centre();
  std::array<glm::dvec3, 8> seen = corners(box);
  double half_x = 0, half_y = 0, near_z = -diagonal, far_z = diagonal;
  for (glm::dvec3& p : seen) {
    const glm::dvec3 d = p - centre;
    p = {glm::dot(d, axes.right), glm::dot(d, axes.up), glm::dot(d, axes.front)};
    half_x = std::max(half_x, std::abs(p.x));
    half_y = std::max(half_y, std::abs(p.y));
    near_z = std::max(near_z, p.z);
    far_z = std::min(far_z, p.z);
  }
  near_z += kDepthMargin * diagonal;
  far_z -= kDepthMargin * diagonal;
  const double used = 1.0 - 2.0 * options.margin;

  Camera camera{{}, options.width, options.height, options.mm_per_pixel};
  if (camera.width == 0 && camera.height == 0 && options.mm_per_pixel > 0) {
    const double border = options.margin / used * 2.0 * std::max(half_x, half_y);
    const double w = std::ceil(2.0 * (half_x + border) / options.mm_per_pixel);
    const double h = std::ceil(2.0 * (half_y + border) / options.mm_per_pixel);
    if (w > kMaxPictureSide || h > kMaxPictureSide)
      return fail(ErrorKind::kUsage,
                  "camera: {:.4g} mm per pixel makes a picture of {:.0f} x {:.0f} pixels, expected at most {}",
                  options.mm_per_pixel, w, h, kMaxPictureSide);
    camera.width = std::max(1, static_cast<int>(w));
    camera.height = std::max(1, static_cast<int>(h));
  }
  if (camera.width < 1 || camera.height < 1 || camera.width > kMaxPictureSide || camera.height > kMaxPictureSide)
    return fail(ErrorKind::kUsage, "camera: a picture of {} x {} pixels was asked for, expected 1 to {} on each side",
                camera.width, camera.height, kMaxPictureSide);
  const double w = camera.width, h = camera.height;

  glm::dvec3 eye = centre;
  if (options.perspective) {
    const double tan_long = std::tan(radians(options.field_of_view_deg) / 2);
    const double tan_x = tan_long * w / std::max(w, h), tan_y = tan_long * h / std::max(w, h);
    double distance = 0;
    for (const glm::dvec3& p : seen)
      distance = std::max({distance, p.z + std::abs(p.x) / (tan_x * used), p.z + std::abs(p.y) / (tan_y * used)});
    distance = std::max(distance, near_z + kDepthMargin * diagonal);
    eye += distance * axes.front;
    const double near_plane = distance - near_z, far_plane = distance - far_z;
    camera.view.clip_from_view = glm::frustum(-near_plane * tan_x, near_plane * tan_x, -near_plane * tan_y,
                                              near_plane * tan_y, near_plane, far_plane);
    camera.mm_per_pixel = 2.0 * distance * tan_x / w;
  } else {
    if (camera.mm_per_pixel == 0) camera.mm_per_pixel = std::max(2 * half_x / (w * used), 2 * half_y / (h * used));
    const double x = camera.mm_per_pixel * w / 2, y = camera.mm_per_pixel * h / 2;
    camera.view.clip_from_view = glm::ortho(-x, x, -y, y, -near_z, -far_z);
  }
  glm::dmat4& m = camera.view.view_from_world;
  const std::array<glm::dvec3, 3> rows{axes.right, axes.up, axes.front};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m[c][r] = rows[r][c];
    m[3][r] = -glm::dot(rows[r], eye);
  }
  return camera;
}

}  // namespace dubsar
