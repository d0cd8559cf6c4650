#pragma once
// From the pictures of two real lenses to pictures of two ideal ones: same focal length, parallel axes, square pixels.

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "devices/leap/lmc1_calibration.h"

namespace dubsar {

struct StereoLenses {
  int width = 0, height = 0;  ///< of the device's pictures
  double baseline_m = 0.0;
  double focal_px = 134.0;  ///< of the ideal pictures
  /// Ray (x/z, y/z) to pixel of the device's picture; left, right. Nothing: not seen.
  std::function<std::optional<glm::dvec2>(const glm::dvec2&)> pixel_from_ray[2];
  std::function<glm::dvec2(const glm::dvec2&)> ray_from_pixel[2];  ///< the way back
};

StereoLenses stereo_lenses(const lmc1::Calibration& calibration, int width, int height);

/// Ideal pictures cover rays up to 2 (63 degrees) to the sides and 1.5 (56 degrees) up and down. One thread.
class StereoRig {
 public:
  explicit StereoRig(const StereoLenses& lenses);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  double focal_px() const noexcept { return focal_px_; }
  double baseline_m() const noexcept { return baseline_m_; }
  std::size_t device_pixels() const noexcept { return device_pixels_; }

  glm::dvec2 ray(const glm::dvec2& pixel) const noexcept {
    return {(pixel.x - 0.5 * (width_ - 1)) / focal_px_, (pixel.y - 0.5 * (height_ - 1)) / focal_px_};
  }

  /// Rows [y0, y1) and columns [x0, x1) of the ideal picture `eye` (0 left, 1 right) into the same place of `out`
  /// (width() * height()), bilinear; 0 where the lens sees nothing.
  void rectify(int eye, std::span<const std::uint8_t> picture, int x0, int y0, int x1, int y1,
               std::span<std::uint8_t> out) const noexcept;

 private:
  struct Tap {
    std::uint32_t offset;              // of the upper left pixel; kUnseen
    std::uint16_t weight_x, weight_y;  // of the right and lower one, /256
  };
  static constexpr std::uint32_t kUnseen = 0xffffffffU;

  int width_, height_, device_width_;
  double focal_px_, baseline_m_;
  std::size_t device_pixels_;
  std::vector<Tap> taps_[2];
};

}  // namespace dubsar
