#pragma once
// Row kernels of the binomial low-pass filters, vectorised with run-time dispatch. Internal to core/volume.

#include <cstdint>

namespace dubsar::kernels {

/// out[x] = the 3x3 neighbours in y and z of x weighted by [1 2 1]/4 per axis, x in [0, n). `rows[3 * dz + dy]`.
/// No FMA rounding and no overflow: the products with 1/4 and 1/2 are exact, so every processor gives the same bits.
void gauss3_yz(const float* const rows[9], std::int64_t n, float* out);

/// out[x] = scale * ([1 2 1]/4 at in[x - 1], in[x], in[x + 1]), x in [0, n); in[-1] and in[n] must be readable.
void gauss3_x(const float* in, std::int64_t n, float scale, float* out);

/// out[i] = [1 2 1]/4 at in[2 i], in[2 i + 1], in[2 i + 2], i in [0, n); in[2 n] must be readable.
void gauss3_x_half(const float* in, std::int64_t n, float* out);

/// out[x] = sum over `count` rows of weights[k] * rows[k][x], x in [0, n), added in rising k.
void weighted_rows(const float* const* rows, const float* weights, int count, std::int64_t n, float* out);

/// out[x] = sum over k in [0, taps) of weights[k] * in[x + k - taps / 2], x in [0, n).
void weighted_taps(const float* in, const float* weights, int taps, std::int64_t n, float* out);

}  // namespace dubsar::kernels
