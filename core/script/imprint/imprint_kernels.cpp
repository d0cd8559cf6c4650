#include "core/script/imprint/imprint_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/script/imprint/imprint_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::imprint_kernels {
namespace HWY_NAMESPACE {

// Plain loops: the compiler makes vectors of them, once for each target.
constexpr std::size_t kLanes = 8;

HWY_INLINE float larger(float a, float b) { return a < b ? b : a; }
HWY_INLINE float smaller(float a, float b) { return b < a ? b : a; }
HWY_INLINE float amount(float a) { return a < 0.0f ? -a : a; }

/// What rounding takes where two planes are this far apart.
HWY_INLINE float rounded(const Planes& p, float apart) {
  const float h = larger(0.0f, p.rounding - apart);
  return h * h * p.quarter;
}

HWY_INLINE float depth_at(const Planes& p, float px, float py) {
  const float dx = px - p.x, dy = py - p.y;
  const float a = p.c * dx + p.s * dy, b = amount(p.c * dy - p.s * dx);
  const float back = p.depth + a * p.head, behind = p.depth - a * p.tip - p.flank * b - rounded(p, 2.0f * p.flank * b);
  const float of_head = smaller(back, behind) - rounded(p, amount(back - behind));
  const float tail = p.groove - a * p.groove_tip - p.groove_flank * b - rounded(p, 2.0f * p.groove_flank * b);
  const float of_tail = a >= 0.0f ? tail : -1.0f;
  return larger(0.0f, larger(of_head, of_tail));
}

HWY_INLINE float lost(const Planes& p, const Samples& s, const Loss& loss, std::size_t i) {
  const float r = s.depth[i] - larger(s.others[i], depth_at(p, s.x[i], s.y[i]));
  const float q = r * r * loss.per_square;
  return s.weight[i] * ((r > 0.0f ? loss.deeper : 1.0f) * loss.square * q / (1.0f + q * loss.per_most));
}

HWY_INLINE double total(const float* sums) {
  double sum = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) sum += static_cast<double>(sums[lane]);
  return sum;
}

void Model(const Planes& planes, const Samples& s, float* HWY_RESTRICT out) {
  const Planes p = planes;
  for (std::size_t i = 0; i < s.count; ++i) out[i] = larger(s.others[i], depth_at(p, s.x[i], s.y[i]));
}

double Misfit(const Planes& planes, const Samples& samples, const Loss& how) {
  const Planes p = planes;
  const Samples s = samples;
  const Loss loss = how;
  float sums[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= s.count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += lost(p, s, loss, i + lane);
  for (; i < s.count; ++i) sums[0] += lost(p, s, loss, i);
  return total(sums);
}

double ProductOfTwo(const float* a, const float* b, std::size_t count) {
  float sums[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  for (; i < count; ++i) sums[0] += a[i] * b[i];
  return total(sums);
}

double ProductOfThree(const float* w, const float* a, const float* b, std::size_t count) {
  float sums[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += w[i + lane] * a[i + lane] * b[i + lane];
  for (; i < count; ++i) sums[0] += w[i] * a[i] * b[i];
  return total(sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::imprint_kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::imprint_kernels {

HWY_EXPORT(Model);
HWY_EXPORT(Misfit);
HWY_EXPORT(ProductOfTwo);
HWY_EXPORT(ProductOfThree);

void model(const Planes& planes, const Samples& samples, float* out) {
  HWY_DYNAMIC_DISPATCH(Model)(planes, samples, out);
}
double misfit(const Planes& planes, const Samples& samples, const Loss& loss) {
  return HWY_DYNAMIC_DISPATCH(Misfit)(planes, samples, loss);
}
double product(const float* a, const float* b, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(ProductOfTwo)(a, b, count);
}
double product(const float* w, const float* a, const float* b, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(ProductOfThree)(w, a, b, count);
}

}  // namespace dubsar::imprint_kernels
#endif
