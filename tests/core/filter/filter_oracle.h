#pragma once
// Slow, plain double-precision filters and noise for the tests of resampling and denoising.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "core/filter/denoise.h"
#include "core/volume/volume.h"

namespace dubsar::oracle {

inline Volume<float> make_volume(Dims dims, const std::function<double(std::int64_t, std::int64_t, std::int64_t)>& f) {
  Volume<float> volume(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) volume.at(x, y, z) = static_cast<float>(f(x, y, z));
  return volume;
}

inline double clamped(const Volume<float>& v, std::int64_t x, std::int64_t y, std::int64_t z) {
  return v.at(std::clamp<std::int64_t>(x, 0, v.dims.x - 1), std::clamp<std::int64_t>(y, 0, v.dims.y - 1),
              std::clamp<std::int64_t>(z, 0, v.dims.z - 1));
}

/// Gaussian noise by Box and Muller: the same numbers with every standard library.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : bits_(seed) {}
  double operator()() {
    const double u = (static_cast<double>(bits_() >> 11) + 0.5) / 9007199254740992.0;
    const double v = static_cast<double>(bits_() >> 11) / 9007199254740992.0;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::mt19937_64 bits_;
};

inline double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

/// Weighted sum over the window around (x, y, z), weights of integer offsets.
inline double window_gauss(const Volume<float>& v, int window, std::int64_t x, std::int64_t y, std::int64_t z) {
  const int r = window / 2;
  double sum = 0.0;
  for (int c = -r; c <= r; ++c)
    for (int b = -r; b <= r; ++b)
      for (int a = -r; a <= r; ++a)
        sum +=
            binomial(2 * r, a + r) * binomial(2 * r, b + r) * binomial(2 * r, c + r) * clamped(v, x + a, y + b, z + c);
  return sum / std::pow(2.0, 6.0 * r);
}

inline double range_weight(const DenoiseOptions& options, double difference) {
  const double d = difference / options.sigma;
  if (options.range == RangeWeight::kGauss) return std::exp(-0.5 * d * d);
  const double wide = 1.0 / std::sqrt(1.0 - std::exp(-0.25)), t = 1.0 - d * d / (wide * wide);
  return std::abs(d) < wide ? t * t : 0.0;
}

/// One iteration of any filter, by its definition.
inline Volume<double> denoise_once(const Volume<float>& v, const DenoiseOptions& options) {
  Volume<double> guide(v.dims), out(v.dims);
  const Dims n = v.dims;
  const int r = options.window / 2;
  const auto each = [&](const auto& body) {
    for (std::int64_t z = 0; z < n.z; ++z)
      for (std::int64_t y = 0; y < n.y; ++y)
        for (std::int64_t x = 0; x < n.x; ++x) body(x, y, z);
  };
  each([&](auto x, auto y, auto z) {
    guide.at(x, y, z) = options.method == DenoiseMethod::kJointBilateral ? window_gauss(v, 3, x, y, z) : v.at(x, y, z);
  });
  each([&](auto x, auto y, auto z) {
    if (options.method == DenoiseMethod::kGauss) {
      out.at(x, y, z) = window_gauss(v, options.window, x, y, z);
      return;
    }
    std::vector<double> values;
    double weights = 0.0, sum = 0.0;
    for (int c = -r; c <= r; ++c)
      for (int b = -r; b <= r; ++b)
        for (int a = -r; a <= r; ++a) {
          const std::int64_t at_x = std::clamp<std::int64_t>(x + a, 0, n.x - 1),
                             at_y = std::clamp<std::int64_t>(y + b, 0, n.y - 1),
                             at_z = std::clamp<std::int64_t>(z + c, 0, n.z - 1);
          values.push_back(v.at(at_x, at_y, at_z));
          const double weight = binomial(2 * r, a + r) * binomial(2 * r, b + r) * binomial(2 * r, c + r) *
                                range_weight(options, guide.at(at_x, at_y, at_z) - guide.at(x, y, z));
          weights += weight;
          sum += weight * values.back();
        }
    if (options.method == DenoiseMethod::kMedian) {
      std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
      out.at(x, y, z) = values[values.size() / 2];
    } else {
      out.at(x, y, z) = sum / weights;
    }
  });
  return out;
}

/// White noise through the point spread function [1 4 1]/6 per axis, scaled to a standard deviation of `sigma`:
/// noise as correlated as that of a CT reconstruction, so that Gauss 3x3x3 gains 6.6 dB (design note: denoising).
inline Volume<float> correlated_noise(Dims dims, double sigma, std::uint64_t seed) {
  Noise noise(seed);
  Volume<float> v = make_volume(dims, [&](auto, auto, auto) { return noise(); });
  for (int axis = 0; axis < 3; ++axis) {
    const Volume<float> from = make_volume(dims, [&](auto x, auto y, auto z) { return v.at(x, y, z); });
    v = make_volume(dims, [&](auto x, auto y, auto z) {
      const std::int64_t dx = axis == 0, dy = axis == 1, dz = axis == 2;
      const auto at = [&](std::int64_t s) {  // periodic: the same statistics everywhere
        return from.at((x + s * dx + dims.x) % dims.x, (y + s * dy + dims.y) % dims.y, (z + s * dz + dims.z) % dims.z);
      };
      return (at(-1) + 4.0 * at(0) + at(1)) / 6.0;
    });
  }
  const double scale = sigma / std::pow(std::sqrt(18.0) / 6.0, 3.0);  // sqrt(1 + 16 + 1) / 6 per axis
  for (float& value : v.voxels.span()) value = static_cast<float>(value * scale);
  return v;
}

struct Moments {
  double mean = 0.0, sigma = 0.0;
};
/// Mean and standard deviation of the voxels with x in [x_begin, x_end) that are `margin` away from the other borders.
inline Moments moments(const Volume<float>& v, std::int64_t x_begin, std::int64_t x_end, std::int64_t margin) {
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (std::int64_t z = margin; z < v.dims.z - margin; ++z)
    for (std::int64_t y = margin; y < v.dims.y - margin; ++y)
      for (std::int64_t x = x_begin; x < x_end; ++x) {
        count += 1.0;
        sum += v.at(x, y, z);
        squares += static_cast<double>(v.at(x, y, z)) * v.at(x, y, z);
      }
  return {sum / count, std::sqrt(squares / count - sum / count * (sum / count))};
}

}  // namespace dubsar::oracle
