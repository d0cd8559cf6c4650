#include "core/filter/gauss_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/gauss_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls body(x, tag) for [0, n): whole vectors, then single lanes. Both do the same arithmetic per lane.
template <class Body>
HWY_INLINE void for_lanes(std::int64_t n, const Body& body) {
  const hn::ScalableTag<float> wide;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(wide));
  std::int64_t x = 0;
  for (; x + lanes <= n; x += lanes) body(x, wide);
  const hn::CappedTag<float, 1> one;
  for (; x < n; ++x) body(x, one);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V low_pass(D d, V a, V b, V c) {
  const V quarter = hn::Set(d, 0.25F);
  return hn::MulAdd(hn::Set(d, 0.5F), b, hn::MulAdd(quarter, a, hn::Mul(quarter, c)));
}

void Gauss3Yz(const float* const rows[9], std::int64_t n, float* HWY_RESTRICT out) {
  for_lanes(n, [&](std::int64_t x, auto d) HWY_ATTR {
    const auto at = [&](int k) HWY_ATTR { return hn::LoadU(d, rows[k] + x); };
    const auto low = low_pass(d, at(0), at(3), at(6));
    const auto mid = low_pass(d, at(1), at(4), at(7));
    const auto high = low_pass(d, at(2), at(5), at(8));
    hn::StoreU(low_pass(d, low, mid, high), d, out + x);
  });
}

void Gauss3X(const float* HWY_RESTRICT in, std::int64_t n, float scale, float* HWY_RESTRICT out) {
  for_lanes(n, [&](std::int64_t x, auto d) HWY_ATTR {
    const auto value = low_pass(d, hn::LoadU(d, in + x - 1), hn::LoadU(d, in + x), hn::LoadU(d, in + x + 1));
    hn::StoreU(hn::Mul(value, hn::Set(d, scale)), d, out + x);
  });
}

void Gauss3XHalf(const float* HWY_RESTRICT in, std::int64_t n, float* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  std::int64_t i = 0;
  for (; i + lanes < n; i += lanes) {  // one output is left for the loop below: in[2 n + 1] need not be readable
    hn::Vec<decltype(d)> first, centre, last, unused;
    hn::LoadInterleaved2(d, in + 2 * i, first, centre);
    hn::LoadInterleaved2(d, in + 2 * i + 2, last, unused);
    hn::StoreU(low_pass(d, first, centre, last), d, out + i);
  }
  const hn::CappedTag<float, 1> one;
  for (; i < n; ++i) {
    const float* at = in + 2 * i;
    hn::StoreU(low_pass(one, hn::Set(one, at[0]), hn::Set(one, at[1]), hn::Set(one, at[2])), one, out + i);
  }
}

void WeightedRows(const float* const* rows, const float* weights, int count, std::int64_t n, float* HWY_RESTRICT out) {
  for_lanes(n, [&](std::int64_t x, auto d) HWY_ATTR {
    auto sum = hn::Zero(d);
    for (int k = 0; k < count; ++k) sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, rows[k] + x)));
    hn::StoreU(sum, d, out + x);
  });
}

void WeightedTaps(const float* HWY_RESTRICT in, const float* weights, int taps, std::int64_t n,
                  float* HWY_RESTRICT out) {
  for_lanes(n, [&](std::int64_t x, auto d) HWY_ATTR {
    auto sum = hn::Zero(d);
    for (int k = 0; k < taps; ++k)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, in + x + k - taps / 2)));
    hn::StoreU(sum, d, out + x);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::kernels {

HWY_EXPORT(Gauss3Yz);
HWY_EXPORT(Gauss3X);
HWY_EXPORT(Gauss3XHalf);
HWY_EXPORT(WeightedRows);
HWY_EXPORT(WeightedTaps);

void gauss3_yz(const float* const rows[9], std::int64_t n, float* out) { HWY_DYNAMIC_DISPATCH(Gauss3Yz)(rows, n, out); }
void gauss3_x(const float* in, std::int64_t n, float scale, float* out) {
  HWY_DYNAMIC_DISPATCH(Gauss3X)(in, n, scale, out);
}
void gauss3_x_half(const float* in, std::int64_t n, float* out) { HWY_DYNAMIC_DISPATCH(Gauss3XHalf)(in, n, out); }
void weighted_rows(const float* const* rows, const float* weights, int count, std::int64_t n, float* out) {
  HWY_DYNAMIC_DISPATCH(WeightedRows)(rows, weights, count, n, out);
}
void weighted_taps(const float* in, const float* weights, int taps, std::int64_t n, float* out) {
  HWY_DYNAMIC_DISPATCH(WeightedTaps)(in, weights, taps, n, out);
}

}  // namespace dubsar::kernels
#endif
