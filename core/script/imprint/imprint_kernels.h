#pragma once
// The sums over samples that fits of imprints are made of, for whatever vectors the processor has. All are the same
// bits on each: eight sums beside each other, no fused multiply and add.

#include <cstddef>

namespace dubsar::imprint_kernels {

/// The planes of an imprint (imprint.h), ready for many places.
struct Planes {
  float x, y, c, s;                        ///< of T; cosine and sine of the direction
  float depth, head, tip, flank;           ///< slopes, of the head
  float groove, groove_tip, groove_flank;  ///< -1 where there is none
  float rounding, quarter;                 ///< width that inner edges are rounded by; a quarter over it
};

struct Samples {
  const float *x, *y, *depth, *weight, *others;
  std::size_t count;
};

/// Bounded squares: q / (1 + q / most) of squares of r over the scale's; deeper clay counts so much of shallower.
struct Loss {
  float per_square, square, per_most, deeper;
};

/// The deeper of planes and others at each sample.
void model(const Planes& planes, const Samples& samples, float* out);
/// Sum of weight times loss.
double misfit(const Planes& planes, const Samples& samples, const Loss& loss);
/// Sums of a b, and of w a b.
double product(const float* a, const float* b, std::size_t count);
double product(const float* w, const float* a, const float* b, std::size_t count);

}  // namespace dubsar::imprint_kernels
