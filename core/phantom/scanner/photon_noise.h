#pragma once
// Random numbers of a pixel, whatever was drawn for its neighbours.

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/phantom/random.h"

namespace dubsar::phantom {

/// Uniform in (0, 1), and from the standard normal law ([Box 1958]), each from its own 32 bits of a key.
struct PixelDraw {
  double uniform, normal;
  explicit PixelDraw(std::uint64_t key) {
    const std::uint64_t bits = hash64(key);
    uniform = (static_cast<double>(bits >> 32) + 0.5) * 0x1p-32;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
    normal = std::sqrt(-2.0 * std::log(uniform)) * std::cos(angle);
  }
};

/// A count of the Poisson law: by inversion below 30, above by the normal law with its skewness corrected, where mean,
/// variance and skewness are right to 1 %.
inline double poisson(double mean, const PixelDraw& draw) {
  if (mean >= 30.0)
    return std::max(0.0, std::round(mean + std::sqrt(mean) * draw.normal + (draw.normal * draw.normal - 1.0) / 6.0));
  double term = std::exp(-mean), sum = term;
  int count = 0;
  while (sum < draw.uniform && count < 200) {
    ++count;
    term *= mean / count;
    sum += term;
  }
  return count;
}

}  // namespace dubsar::phantom
