#include "input/tracking/hands/stereo_rig.h"

#include <cmath>

namespace dubsar {

StereoLenses stereo_lenses(const lmc1::Calibration& calibration, int width, int height) {
  StereoLenses lenses;
  lenses.width = width;
  lenses.height = height;
  lenses.baseline_m = 1e-3 * static_cast<double>(calibration.baseline_mm);
  lenses.focal_px = 0.5 * static_cast<double>(calibration.left.focal_px + calibration.right.focal_px);
  const lmc1::Lens left(calibration.left, width, height), right(calibration.right, width, height);
  lenses.pixel_from_ray[0] = [left](const glm::dvec2& ray) { return left.pixel_from_ray(ray); };
  lenses.pixel_from_ray[1] = [right](const glm::dvec2& ray) { return right.pixel_from_ray(ray); };
  lenses.ray_from_pixel[0] = [left](const glm::dvec2& pixel) { return left.ray_from_pixel(pixel); };
  lenses.ray_from_pixel[1] = [right](const glm::dvec2& pixel) { return right.ray_from_pixel(pixel); };
  return lenses;
}

StereoRig::StereoRig(const StereoLenses& lenses)
    : width_(2 * static_cast<int>(std::lround(2.0 * lenses.focal_px))),
      height_(2 * static_cast<int>(std::lround(1.5 * lenses.focal_px))),
      device_width_(lenses.width),
      focal_px_(lenses.focal_px),
      baseline_m_(lenses.baseline_m),
      device_pixels_(static_cast<std::size_t>(lenses.width) * static_cast<std::size_t>(lenses.height)) {
  for (int eye = 0; eye < 2; ++eye) {
    taps_[eye].reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const auto pixel = lenses.pixel_from_ray[eye](ray({x, y}));
        if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x >= lenses.width - 1 ||
            pixel->y >= lenses.height - 1) {
          taps_[eye].push_back({kUnseen, 0, 0});
          continue;
        }
        const double left = std::floor(pixel->x), top = std::floor(pixel->y);
        taps_[eye].push_back({static_cast<std::uint32_t>(top) * static_cast<std::uint32_t>(lenses.width) +
                                  static_cast<std::uint32_t>(left),
                              static_cast<std::uint16_t>(256.0 * (pixel->x - left)),
                              static_cast<std::uint16_t>(256.0 * (pixel->y - top))});
      }
  }
}

void StereoRig::rectify(int eye, std::span<const std::uint8_t> picture, int x0, int y0, int x1, int y1,
                        std::span<std::uint8_t> out) const noexcept {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
      const Tap tap = taps_[eye][at];
      if (tap.offset == kUnseen) {
        out[at] = 0;
        continue;
      }
      const std::uint8_t* p = picture.data() + tap.offset;
      const unsigned top = p[0] * (256U - tap.weight_x) + p[1] * static_cast<unsigned>(tap.weight_x);
      const unsigned low =
          p[device_width_] * (256U - tap.weight_x) + p[device_width_ + 1] * static_cast<unsigned>(tap.weight_x);
      out[at] = static_cast<std::uint8_t>((top * (256U - tap.weight_y) + low * tap.weight_y + 32768U) >> 16);
    }
}

}  // namespace dubsar
