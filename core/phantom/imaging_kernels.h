#pragma once
// What the scanner adds: noise and blur, row by row (SIMD, chosen at run time; the same bits on every processor).

#include <cmath>
#include <cstdint>
#include <span>

namespace dubsar::phantom::kernels {

/// Adds white noise of standard deviation `sigma` to a row whose first voxel is `x_first`. The noise of a voxel is a
/// pure function of `row_key` and x: two rounds of a 32-bit mixer (lowbias32, C. Wellons 2018) give four 16-bit
/// uniform numbers, whose sum is close to Gaussian (excess kurtosis -0.3, after the PSF -0.15).
void add_noise(std::uint64_t row_key, std::int64_t x_first, float sigma, std::span<float> row);

/// The PSF [1 m 1] / (2 + m) along each axis, not yet along x: out = sum of 9 rows with weights 1 m 1 in y and z
/// ((2 + m)^3 times the blurred value is left to blur_x). rows[3 * dz + dy], each of out.size() floats.
void blur_yz(const float* const rows[9], float middle, std::span<float> out);

/// out[i] = (in[i] + m in[i + 1] + in[i + 2]) / (2 + m)^3; in has two more floats than out.
void blur_x(std::span<const float> in, float middle, std::span<float> out);

/// The middle weight m of the PSF whose standard deviation along an axis is `deviation` voxels, up to sqrt(2/3).
inline double psf_middle(double deviation) { return 2.0 / (deviation * deviation) - 2.0; }

/// Standard deviation that is left of white noise of 1 by the PSF.
inline double noise_left(double middle) {
  const double sum = 2.0 + middle, share = (2.0 + middle * middle) / (sum * sum);
  return share * std::sqrt(share);
}

}  // namespace dubsar::phantom::kernels
