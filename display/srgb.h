#pragma once
// sRGB coding (IEC 61966-2-1): bytes are coded, light is added linearly.

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace dubsar {

/// Byte to linear light 0..1.
inline double linear_from_srgb(std::uint8_t coded) {
  const double c = coded / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// Linear light, clamped to 0..1, to the nearest byte.
inline std::uint8_t srgb_from_linear(double light) {
  const double c = std::clamp(light, 0.0, 1.0);
  const double coded = c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * coded));
}

}  // namespace dubsar
