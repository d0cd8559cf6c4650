#pragma once
// Sums of columns, and Fourier transforms of many rows at once (SIMD, chosen at run time; the same bits on every
// processor: no fused multiply-add).

#include <cstdint>
#include <span>

namespace dubsar::phantom::kernels {

/// Two neighbouring columns with their weights. In a cone the number i of the sum lies at `start + step * i` of the
/// columns.
struct Tap {
  const float* first;
  const float* second;
  float first_weight, second_weight;
  float start = 0.0f, step = 1.0f;
};

/// out[i] += sum over taps of first_weight * first[i] + second_weight * second[i]. out.size() is a multiple of 16; the
/// columns are as long.
void sum_straight(std::span<const Tap> taps, std::span<float> out);

/// The same at the places start + step * i, cut to [0, last], by linear interpolation. Steps are positive; 33 numbers
/// behind the last must be readable, whatever they are.
void sum_magnified(std::span<const Tap> taps, float last, std::span<float> out);

/// Rows of one transform: number k of row r stands at [16 k + r].
inline constexpr std::int64_t kLanes = 16;

/// Discrete Fourier transform of 16 complex rows of `length` (a power of two) in place, by decimation in frequency:
/// the result is in bit-reversed order. cosine[k], sine[k]: of 2 pi k / length, k < length / 2.
void transform(std::span<const float> cosine, std::span<const float> sine, std::span<float> real,
               std::span<float> imaginary);
/// From bit-reversed order back, not divided by the length.
void transform_back(std::span<const float> cosine, std::span<const float> sine, std::span<float> real,
                    std::span<float> imaginary);

}  // namespace dubsar::phantom::kernels
