#include "core/phantom/imaging_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/phantom/imaging_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::phantom::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls body(i, tag) for [0, n): whole vectors, then single lanes, the same arithmetic per lane. No fused
// multiply-add: it would round differently where the processor has none.
template <class Body>
HWY_INLINE void for_lanes(std::int64_t n, const Body& body) {
  const hn::ScalableTag<float> wide;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(wide));
  std::int64_t i = 0;
  for (; i + lanes <= n; i += lanes) body(i, wide);
  const hn::CappedTag<float, 1> one;
  for (; i < n; ++i) body(i, one);
}

template <class D, class V>
HWY_INLINE V mix(D d, V h, std::uint32_t first, std::uint32_t second) {
  h = hn::Xor(h, hn::ShiftRight<16>(h));
  h = hn::Mul(h, hn::Set(d, first));
  h = hn::Xor(h, hn::ShiftRight<15>(h));
  h = hn::Mul(h, hn::Set(d, second));
  return hn::Xor(h, hn::ShiftRight<16>(h));
}

void AddNoise(std::uint64_t row_key, std::int64_t x_first, float sigma, float* HWY_RESTRICT row, std::int64_t n) {
  const auto key0 = static_cast<std::uint32_t>(row_key), key1 = static_cast<std::uint32_t>(row_key >> 32);
  // The sum of four uniform 16-bit numbers: mean 2 (2^16 - 1), variance 4 (2^32 - 1) / 12.
  constexpr float kMean = 131070.0f, kPerUnit = 1.0f / 37837.2272f;
  const float scale = sigma * kPerUnit;
  for_lanes(n, [&](std::int64_t i, auto d) HWY_ATTR {
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::RebindToSigned<decltype(d)> di;
    const auto x = hn::Iota(du, static_cast<std::uint32_t>(x_first + i));
    const auto low = hn::Set(du, 0xffffu);
    const auto h1 = mix(du, hn::Add(hn::Mul(x, hn::Set(du, 0x9e3779b1u)), hn::Set(du, key0)), 0x7feb352du, 0x846ca68bu);
    const auto h2 = mix(du, hn::Add(h1, hn::Set(du, key1)), 0x2c1b3c6du, 0x297a2d39u);
    const auto sum =
        hn::Add(hn::Add(hn::And(h1, low), hn::ShiftRight<16>(h1)), hn::Add(hn::And(h2, low), hn::ShiftRight<16>(h2)));
    const auto centred = hn::Sub(hn::ConvertTo(d, hn::BitCast(di, sum)), hn::Set(d, kMean));
    hn::StoreU(hn::Add(hn::LoadU(d, row + i), hn::Mul(centred, hn::Set(d, scale))), d, row + i);
  });
}

template <class D, class V>
HWY_INLINE V around_middle(D d, V a, V b, V c, float middle) {
  return hn::Add(hn::Add(a, c), hn::Mul(hn::Set(d, middle), b));
}

void BlurYz(const float* const rows[9], float middle, float* HWY_RESTRICT out, std::int64_t n) {
  for_lanes(n, [&](std::int64_t i, auto d) HWY_ATTR {
    const auto at = [&](int k) HWY_ATTR { return hn::LoadU(d, rows[k] + i); };
    const auto row = [&](int k) HWY_ATTR { return around_middle(d, at(k), at(k + 1), at(k + 2), middle); };
    hn::StoreU(around_middle(d, row(0), row(3), row(6), middle), d, out + i);
  });
}

void BlurX(const float* HWY_RESTRICT in, float middle, float* HWY_RESTRICT out, std::int64_t n) {
  const float sum_of_weights = 2.0f + middle, share = 1.0f / (sum_of_weights * sum_of_weights * sum_of_weights);
  for_lanes(n, [&](std::int64_t i, auto d) HWY_ATTR {
    const auto sum = around_middle(d, hn::LoadU(d, in + i), hn::LoadU(d, in + i + 1), hn::LoadU(d, in + i + 2), middle);
    hn::StoreU(hn::Mul(sum, hn::Set(d, share)), d, out + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::phantom::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::phantom::kernels {

HWY_EXPORT(AddNoise);
HWY_EXPORT(BlurYz);
HWY_EXPORT(BlurX);

void add_noise(std::uint64_t row_key, std::int64_t x_first, float sigma, std::span<float> row) {
  HWY_DYNAMIC_DISPATCH(AddNoise)(row_key, x_first, sigma, row.data(), static_cast<std::int64_t>(row.size()));
}
void blur_yz(const float* const rows[9], float middle, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(BlurYz)(rows, middle, out.data(), static_cast<std::int64_t>(out.size()));
}
void blur_x(std::span<const float> in, float middle, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(BlurX)(in.data(), middle, out.data(), static_cast<std::int64_t>(out.size()));
}

}  // namespace dubsar::phantom::kernels
#endif
