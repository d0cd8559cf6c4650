#pragma once
// The factory calibration that every Leap Motion Controller carries, and the lens model it describes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "core/base/result.h"

namespace dubsar::lmc1 {

/// Calibration bytes are read one by one: the address goes to sharpness, the byte comes from saturation. The blob lies
/// at addresses 100 to 255.
inline constexpr int kCalibrationAddress = 100;
inline constexpr std::size_t kCalibrationBytes = 156;

struct EyeCalibration {
  float focal_px = 0;                      ///< at 640x480
  float offset_x_px = 0, offset_y_px = 0;  ///< principal point minus (320, 240)
  std::array<float, 2> tangential{};
  /// Numerator, then denominator of the radial factor, in powers of r^2. The stored function goes from the picture to
  /// the ray, the inverse of OpenCV's model.
  std::array<float, 6> radial{};
  float old_focal_px = 0, old_centre_x_px = 0, old_centre_y_px = 0;
  std::array<float, 3> cayley{};  ///< turns rays of the rig into those of the eye
  bool operator==(const EyeCalibration&) const = default;
};

struct Calibration {
  std::uint8_t version = 0, score = 0;
  std::uint32_t unix_time = 0;
  float baseline_mm = 0;
  float q2_init = 0;
  EyeCalibration left, right;
  std::uint32_t checksum = 0;  ///< kept as read: the function is not known, so it is not checked
  bool operator==(const Calibration&) const = default;
};

/// kBadData when the signature "CA" is missing, or a baseline or focal length is not that of such a device, or a number
/// is not finite.
Result<Calibration> decode_calibration(std::span<const std::byte> bytes);
std::array<std::byte, kCalibrationBytes> encode(const Calibration& calibration) noexcept;

/// One eye in a given video mode: pixels to rays and back. Rays are (x/z, y/z) in the frame of both eyes together: x to
/// the right eye, y down the picture, z out of the device.
class Lens {
 public:
  /// `height` 240 and 120 are binned vertically; the width must be 640 (the wide modes are cropped differently, not
  /// checked on a device).
  Lens(const EyeCalibration& eye, int width, int height) noexcept;

  glm::dvec2 ray_from_pixel(const glm::dvec2& pixel) const noexcept;
  /// Nothing for rays that the lens cannot see.
  std::optional<glm::dvec2> pixel_from_ray(const glm::dvec2& ray) const noexcept;

 private:
  double radial_factor(double r2) const noexcept;
  double image_radius(double ray_radius) const noexcept;  ///< the inverse of r * radial_factor(r * r)
  glm::dvec2 undistorted(const glm::dvec2& image) const noexcept;

  double fx_, fy_, cx_, cy_;
  std::array<double, 6> radial_{};
  std::array<double, 2> tangential_{};
  glm::dmat3 rig_from_eye_{1.0};
  double last_image_radius_;  ///< the radial function rises up to here at least
};

}  // namespace dubsar::lmc1
