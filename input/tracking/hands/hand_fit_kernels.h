#pragma once
// The two inner loops of the hand fit, for the vector instructions of the machine (Highway).

#include <cstddef>

namespace dubsar::kernels {

inline constexpr std::size_t kHandLanes = 16;       ///< rays of a tile, and parameters with padding
inline constexpr std::size_t kHandParameters = 16;  ///< of the hand

/// A round cone in the frame of an eye, metres: a + s e, radius radius_a + s radius_change.
struct ConeTerms {
  float ax, ay, az, ex, ey, ez;
  float aa, ae, ee;  ///< products of a and e
  float shift;       ///< what s the outline touches at, beside the point nearest to the ray
  float radius_a, radius_change;
};

/// How a cone's ends and radii move with each parameter; unused parameters 0.
struct ConeSlopes {
  alignas(64) float ax[kHandLanes], ay[kHandLanes], az[kHandLanes], bx[kHandLanes], by[kHandLanes], bz[kHandLanes],
      radius_a[kHandLanes], radius_b[kHandLanes];
};

/// Skin counts from half of `full` on, a part of the brightness of skin that faces the light. A cone lit from
/// the eye gets darker towards its rim and reaches that level at sqrt(1 - full^2 / 4) of its radius; lit from
/// light_x_m beside the eye, at more on the side of the light and at less on the other.
struct Outline {
  float half, light_x_m;
};

/// Unit rays, measured skin share and weight of a tile; depth[i] of ray i inside the outline of cone[i].
struct TileView {
  const float *x, *y, *z, *skin, *weight;
  float *depth, *cone;
};

/// Normal equations: matrix symmetric (all of it), row j at kHandLanes * j.
struct NormalSums {
  alignas(64) float matrix[kHandParameters * kHandLanes];
  alignas(64) float gradient[kHandLanes];
};

/// Where the cone's outline is deeper around ray i than depth[i], puts it there and `id` into cone[i].
void deepen(const ConeTerms& cone, float id, const Outline& outline, const TileView& tile);

/// Adds the samples whose depth is less than `blur` from the outline; returns the sum of weighted squares of
/// all samples.
float add_samples(const ConeTerms* cones, const ConeSlopes* slopes, const Outline& outline, const TileView& tile,
                  float blur, NormalSums& sums);

}  // namespace dubsar::kernels
