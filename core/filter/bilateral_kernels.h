#pragma once
// Row kernels of the bilateral filters and the median, vectorised with run-time dispatch. Internal to core/volume.

#include <cstdint>

namespace dubsar::kernels {

/// What one output row sees. Row pointers are those of all (2 radius + 1)^2 neighbours in z and y,
/// `rows[(2 radius + 1) * dz + dy]`; each must be readable 20 voxels before and after the range worked on.
struct Window {
  const float* const* image;  ///< values that are averaged (or sorted)
  const float* const* guide;  ///< joint image, scaled so that the range weight is a function of the difference alone
  int radius;                 ///< 1..3
};

/// Spatial weights of bilateral(): binomial, [1 2 1], [1 4 6 4 1] or [1 6 15 20 15 6 1] per axis (centre: 1).
inline constexpr int kMaxRadius = 3;

/// out[x] = sum w I / sum w over the window, w = spatial * tukey(guide difference), x in [begin, end), where
/// tukey(d) = (1 - d^2)^2 below 1 and 0 from there on.
void bilateral_tukey(const Window& window, std::int64_t begin, std::int64_t end, float* out);

/// Same with the range weight exp(-d^2).
void bilateral_gauss(const Window& window, std::int64_t begin, std::int64_t end, float* out);

/// out[x] = the median of the window, x in [begin, end). Always one of the values.
void median(const Window& window, std::int64_t begin, std::int64_t end, float* out);

}  // namespace dubsar::kernels
