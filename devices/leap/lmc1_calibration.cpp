#include "devices/leap/lmc1_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace dubsar::lmc1 {
namespace {

// Where the fields lie, all little-endian: "CA", version, score, time, baseline, q2, twice 17 floats, checksum.
constexpr std::size_t kTimeAt = 4, kBaselineAt = 8, kQ2At = 12, kLeftAt = 16, kEyeBytes = 17 * 4,
                      kRightAt = kLeftAt + kEyeBytes, kChecksumAt = kRightAt + kEyeBytes;
static_assert(kChecksumAt + 4 == kCalibrationBytes);

constexpr std::array<float EyeCalibration::*, 3> kFirst{&EyeCalibration::focal_px, &EyeCalibration::offset_x_px,
                                                        &EyeCalibration::offset_y_px};
constexpr std::array<float EyeCalibration::*, 3> kOld{&EyeCalibration::old_focal_px, &EyeCalibration::old_centre_x_px,
                                                      &EyeCalibration::old_centre_y_px};

/// Calls visit(field) for the 17 floats of an eye in the order of the blob.
template <class Eye, class Visit>
void for_each_field(Eye& eye, const Visit& visit) {
  for (const auto member : kFirst) visit(eye.*member);
  for (auto& value : eye.tangential) visit(value);
  for (auto& value : eye.radial) visit(value);
  for (const auto member : kOld) visit(eye.*member);
  for (auto& value : eye.cayley) visit(value);
}

template <class T>
T get(std::span<const std::byte> bytes, std::size_t at) noexcept {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

Result<EyeCalibration> decode_eye(std::span<const std::byte> bytes, std::size_t at, const char* name) {
  EyeCalibration eye;
  bool finite = true;
  for_each_field(eye, [&](float& field) {
    field = get<float>(bytes, at);
    finite = finite && std::isfinite(field);
    at += sizeof(float);
  });
  if (!finite)
    return fail(ErrorKind::kBadData, "leap: calibration of the {} eye has a number that is not finite", name);
  if (eye.focal_px < 50.0F || eye.focal_px > 500.0F)
    return fail(ErrorKind::kBadData, "leap: calibration of the {} eye has a focal length of {} px, expected 50 to 500",
                name, eye.focal_px);
  if (std::abs(eye.offset_x_px) > 100.0F || std::abs(eye.offset_y_px) > 100.0F)
    return fail(ErrorKind::kBadData,
                "leap: calibration of the {} eye has its centre {} x {} px off, expected at most 100", name,
                eye.offset_x_px, eye.offset_y_px);
  return eye;
}

// From the eye to the rig: (I + [p]) (I - [p])^-1 of p = -c, as the maker's sample rectifies with
// CayleyTransform(-rotation) (leapmotion/leapuvc Python/leapuvc.py).
glm::dmat3 rig_from_eye_of(const std::array<float, 3>& cayley) {
  const double x = -double{cayley[0]}, y = -double{cayley[1]}, z = -double{cayley[2]};
  const glm::dmat3 cross(0, z, -y, -z, 0, x, y, -x, 0);  // column by column
  const glm::dmat3 one(1.0);
  return (one + cross) * glm::inverse(one - cross);
}

}  // namespace

Result<Calibration> decode_calibration(std::span<const std::byte> bytes) {
  if (bytes.size() != kCalibrationBytes)
    return fail(ErrorKind::kBadData, "leap: calibration of {} bytes, expected {}", bytes.size(), kCalibrationBytes);
  if (bytes[0] != std::byte{'C'} || bytes[1] != std::byte{'A'})
    return fail(ErrorKind::kBadData, "leap: calibration begins with bytes {:#04x} {:#04x}, expected \"CA\"",
                static_cast<int>(bytes[0]), static_cast<int>(bytes[1]));
  Calibration calibration;
  calibration.version = static_cast<std::uint8_t>(bytes[2]);
  calibration.score = static_cast<std::uint8_t>(bytes[3]);
  calibration.unix_time = get<std::uint32_t>(bytes, kTimeAt);
  calibration.baseline_mm = get<float>(bytes, kBaselineAt);
  calibration.q2_init = get<float>(bytes, kQ2At);
  if (!(calibration.baseline_mm >= 10.0F && calibration.baseline_mm <= 200.0F))
    return fail(ErrorKind::kBadData, "leap: calibration has a baseline of {} mm, expected 10 to 200",
                calibration.baseline_mm);
  DUBSAR_ASSIGN(calibration.left, decode_eye(bytes, kLeftAt, "left"));
  DUBSAR_ASSIGN(calibration.right, decode_eye(bytes, kRightAt, "right"));
  calibration.checksum = get<std::uint32_t>(bytes, kChecksumAt);
  return calibration;
}

std::array<std::byte, kCalibrationBytes> encode(const Calibration& calibration) noexcept {
  std::array<std::byte, kCalibrationBytes> bytes{std::byte{'C'}, std::byte{'A'}, std::byte{calibration.version},
                                                 std::byte{calibration.score}};
  std::memcpy(bytes.data() + kTimeAt, &calibration.unix_time, 4);
  std::memcpy(bytes.data() + kBaselineAt, &calibration.baseline_mm, 4);
  std::memcpy(bytes.data() + kQ2At, &calibration.q2_init, 4);
  std::size_t at = kLeftAt;
  for (const EyeCalibration* eye : {&calibration.left, &calibration.right})
    for_each_field(*eye, [&](const float& field) {
      std::memcpy(bytes.data() + at, &field, sizeof field);
      at += sizeof field;
    });
  std::memcpy(bytes.data() + kChecksumAt, &calibration.checksum, 4);
  return bytes;
}

Lens::Lens(const EyeCalibration& eye, int width, int height) noexcept
    : fx_(double{eye.focal_px} * width / 640.0),
      fy_(double{eye.focal_px} * height / 480.0),
      cx_((320.0 + double{eye.offset_x_px}) * width / 640.0),
      cy_((240.0 + double{eye.offset_y_px}) * height / 480.0),
      rig_from_eye_(rig_from_eye_of(eye.cayley)) {
  for (std::size_t i = 0; i < 6; ++i) radial_[i] = eye.radial[i];
  for (std::size_t i = 0; i < 2; ++i) tangential_[i] = eye.tangential[i];
  double radius = 0.0, ray_radius = 0.0;
  while (radius < 4.0) {  // as far as the function rises: beyond it a ray has no unique pixel
    const double next = radius + 0.01, next_ray = next * radial_factor(next * next);
    if (!(next_ray > ray_radius)) break;
    radius = next;
    ray_radius = next_ray;
  }
  last_image_radius_ = radius;
}

double Lens::radial_factor(double r2) const noexcept {
  const double up = 1.0 + r2 * (radial_[0] + r2 * (radial_[1] + r2 * radial_[2]));
  const double down = 1.0 + r2 * (radial_[3] + r2 * (radial_[4] + r2 * radial_[5]));
  return up / down;
}

/// Newton's method on a function that rises, kept between the bounds that are known so far.
double Lens::image_radius(double ray_radius) const noexcept {
  double low = 0.0, high = last_image_radius_, radius = std::min(ray_radius, high);
  for (int i = 0; i < 60; ++i) {
    const double r2 = radius * radius;
    const double up = 1.0 + r2 * (radial_[0] + r2 * (radial_[1] + r2 * radial_[2]));
    const double down = 1.0 + r2 * (radial_[3] + r2 * (radial_[4] + r2 * radial_[5]));
    const double up_slope = radial_[0] + r2 * (2.0 * radial_[1] + r2 * 3.0 * radial_[2]);
    const double down_slope = radial_[3] + r2 * (2.0 * radial_[4] + r2 * 3.0 * radial_[5]);
    const double excess = radius * up / down - ray_radius;
    (excess < 0.0 ? low : high) = radius;
    const double slope = up / down + 2.0 * r2 * (up_slope * down - up * down_slope) / (down * down);
    const double step = slope > 0.0 ? -excess / slope : high;
    if (std::abs(step) < 1e-12) break;
    const double next = radius + step;
    radius = next > low && next < high ? next : 0.5 * (low + high);
  }
  return radius;
}

glm::dvec2 Lens::undistorted(const glm::dvec2& image) const noexcept {
  const double r2 = glm::dot(image, image), xy = 2.0 * image.x * image.y;
  const auto [p1, p2] = tangential_;
  return image * radial_factor(r2) +
         glm::dvec2(p1 * xy + p2 * (r2 + 2.0 * image.x * image.x), p2 * xy + p1 * (r2 + 2.0 * image.y * image.y));
}

glm::dvec2 Lens::ray_from_pixel(const glm::dvec2& pixel) const noexcept {
  const glm::dvec2 flat = undistorted({(pixel.x - cx_) / fx_, (pixel.y - cy_) / fy_});
  const glm::dvec3 ray = rig_from_eye_ * glm::dvec3(flat, 1.0);
  return glm::dvec2(ray) / ray.z;
}

std::optional<glm::dvec2> Lens::pixel_from_ray(const glm::dvec2& ray) const noexcept {
  const glm::dvec3 turned = glm::transpose(rig_from_eye_) * glm::dvec3(ray, 1.0);
  if (turned.z <= 0.0) return std::nullopt;
  const glm::dvec2 target = glm::dvec2(turned) / turned.z;
  // The small tangential part by correcting the target of the radial one.
  glm::dvec2 image(0.0), radial_target = target;
  for (int pass = 0; pass < 4; ++pass) {
    const double wanted = glm::length(radial_target);
    if (last_image_radius_ * radial_factor(last_image_radius_ * last_image_radius_) < wanted) return std::nullopt;
    image = wanted > 0.0 ? radial_target * (image_radius(wanted) / wanted) : glm::dvec2(0.0);
    if (tangential_[0] == 0.0 && tangential_[1] == 0.0) break;
    radial_target += target - undistorted(image);
  }
  return glm::dvec2(image.x * fx_ + cx_, image.y * fy_ + cy_);
}

}  // namespace dubsar::lmc1
