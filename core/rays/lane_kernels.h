#pragma once
// The inner loops of projection and backprojection, for kLanes slices at once: slices are the lanes of vectors, so that
// geometry is computed once for all of them and every load is contiguous. Images and sinograms are arrays of groups of
// kLanes floats.

#include <array>
#include <cstdint>

namespace dubsar::kernels {

inline constexpr std::int64_t kLanes = 16;

/// A band of an image as rays of one direction cross it: along the major axis one step at a time, between two
/// neighbours along the minor one. Beside either end of the minor axis there is nothing.
struct CrossedBand {
  const float* image = nullptr;                     ///< group at major 0, minor 0
  std::int64_t major_stride = 0, minor_stride = 0;  ///< floats
  std::int64_t begin = 0, end = 0;                  ///< along the major axis
  std::int64_t minor = 0;                           ///< groups along the minor axis
  double first = 0.0, per_bin = 0.0,
         per_major = 0.0;  ///< minor place of a ray: first + per_bin * bin + per_major * major
  float weight = 1.0f;     ///< length of a step
};

/// Adds to each of `bins` groups of `row` what its ray meets in the band.
void project_band(const CrossedBand& band, std::int64_t bins, float* row);

/// Rays of some directions through one row of an image: place on the detector = base + x * step, in bins.
struct RowRays {
  const float* const* rows = nullptr;  ///< filtered projections, one a direction
  const double* base = nullptr;
  const double* step = nullptr;
  std::int64_t count = 0;
};

/// Adds to groups [begin, end) of an image's row the projections there, between two bins each. All places must be in
/// [0, bins - 1).
void backproject_row(const RowRays& rays, std::int64_t begin, std::int64_t end, float* row);

/// Weights of four neighbours for a place `part` beyond the second, 0 to 1 (Lagrange).
struct CubicWeights {
  explicit CubicWeights(double part) noexcept
      : of{static_cast<float>(-part * (part - 1.0) * (part - 2.0) / 6.0),
           static_cast<float>((part + 1.0) * (part - 1.0) * (part - 2.0) / 2.0),
           static_cast<float>(-(part + 1.0) * part * (part - 2.0) / 2.0),
           static_cast<float>((part + 1.0) * part * (part - 1.0) / 6.0)} {}
  std::array<float, 4> of;
};

/// Adds to `count` groups of `out`, the first of which lies at `start` of `in`, what cubic interpolation between the
/// `groups` of `in` gives there; beyond its ends are zeros.
void add_interpolated(const float* in, std::int64_t groups, double start, std::int64_t count, float* out);

/// Groups side by side.
struct LaneRow {
  const float* groups = nullptr;
  std::int64_t count = 0;
};

/// Adds to each of `bins` groups of `out` `weight` times what cubic interpolation gives at first + bin * step of `in`;
/// beyond its ends are zeros.
void add_sampled(const LaneRow& in, double first, double step, float weight, std::int64_t bins, float* out);

/// out = in * (1/4 at 0, odd[k] at +-(2 k + 1) up to `reach`, an odd number, 0 elsewhere). `odd` has weights for 6 bins
/// more than the reach. `in` and `out` do not overlap.
void ramp_row(const float* in, std::int64_t bins, const float* odd, std::int64_t reach, float* out);

/// out[k] = sum over cells c of in[c] far[|first + k - c|]. `out` and `far` have kFarOutputs groups (numbers) more than
/// are needed.
inline constexpr std::int64_t kFarOutputs = 4;
void far_row(const float* in, std::int64_t cells, const float* far, std::int64_t first, std::int64_t count, float* out);

}  // namespace dubsar::kernels
