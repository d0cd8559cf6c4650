#pragma once
// sRGB coding (IEC 61966-2-1): bytes are coded, light is added linearly.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace dubsar {

/// Byte to linear light 0..1.
inline double linear_from_srgb(std::uint8_t coded) {
  const double c = coded / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// linear_from_srgb of every byte, for loops over pixels.
inline const std::array<double, 256>& linear_of_byte() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = linear_from_srgb(static_cast<std::uint8_t>(i));
    return out;
  }();
  return table;
}

/// Linear light, clamped to 0..1, to a coded value of 0 to 1.
inline double coded_from_linear(double light) {
  const double c = std::clamp(light, 0.0, 1.0);
  return c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

/// The same to the nearest byte.
inline std::uint8_t srgb_from_linear(double light) {
  return static_cast<std::uint8_t>(std::lround(255.0 * coded_from_linear(light)));
}

}  // namespace dubsar
