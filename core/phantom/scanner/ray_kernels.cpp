#include "core/phantom/scanner/ray_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/phantom/scanner/ray_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::phantom::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::CappedTag<float, 16>;

// Sums stay in registers over all taps: kVectors vectors of a column at a time.
template <int kVectors>
HWY_INLINE void straight_block(const Tap* taps, std::int64_t count, std::int64_t i, float* out) {
  const Wide d;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  static_assert(kVectors == 1 || kVectors == 4);
  auto s0 = hn::LoadU(d, out + i), s1 = s0, s2 = s0, s3 = s0;
  if (kVectors == 4) {
    s1 = hn::LoadU(d, out + i + lanes);
    s2 = hn::LoadU(d, out + i + 2 * lanes);
    s3 = hn::LoadU(d, out + i + 3 * lanes);
  }
  for (std::int64_t k = 0; k < count; ++k) {
    const float* a = taps[k].first + i;
    const float* b = taps[k].second + i;
    const auto wa = hn::Set(d, taps[k].first_weight), wb = hn::Set(d, taps[k].second_weight);
    s0 = hn::Add(s0, hn::Add(hn::Mul(wa, hn::LoadU(d, a)), hn::Mul(wb, hn::LoadU(d, b))));
    if (kVectors == 4) {
      s1 = hn::Add(s1, hn::Add(hn::Mul(wa, hn::LoadU(d, a + lanes)), hn::Mul(wb, hn::LoadU(d, b + lanes))));
      s2 = hn::Add(s2, hn::Add(hn::Mul(wa, hn::LoadU(d, a + 2 * lanes)), hn::Mul(wb, hn::LoadU(d, b + 2 * lanes))));
      s3 = hn::Add(s3, hn::Add(hn::Mul(wa, hn::LoadU(d, a + 3 * lanes)), hn::Mul(wb, hn::LoadU(d, b + 3 * lanes))));
    }
  }
  hn::StoreU(s0, d, out + i);
  if (kVectors == 4) {
    hn::StoreU(s1, d, out + i + lanes);
    hn::StoreU(s2, d, out + i + 2 * lanes);
    hn::StoreU(s3, d, out + i + 3 * lanes);
  }
}

void SumStraight(const Tap* taps, std::int64_t count, float* HWY_RESTRICT out, std::int64_t n) {
  const Wide d;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  std::int64_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) straight_block<4>(taps, count, i, out);
  for (; i < n; i += lanes) straight_block<1>(taps, count, i, out);
}

// What N neighbouring numbers of a sum need of the columns lies within 2 N of them while the steps are short: two loads
// and permutations instead of N loads.
HWY_INLINE bool within_two_vectors(float step, std::int64_t lanes) {
  return static_cast<float>(lanes - 1) * step + 2.0f <= static_cast<float>(2 * lanes - 1);
}

template <class V, class I>
HWY_INLINE V pick(const Wide d, V first, V second, I index) {
  const hn::RebindToSigned<Wide> di;
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
  const auto within = hn::IndicesFromVec(d, hn::And(index, hn::Set(di, lanes - 1)));
  const auto in_second = hn::RebindMask(d, hn::Gt(index, hn::Set(di, lanes - 1)));
  return hn::IfThenElse(in_second, hn::TableLookupLanes(second, within), hn::TableLookupLanes(first, within));
}

void SumMagnified(const Tap* taps, std::int64_t count, float last, float* HWY_RESTRICT out, std::int64_t n) {
  const Wide d;
  const hn::RebindToSigned<Wide> di;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  const auto zero = hn::Zero(d), end = hn::Set(d, last);
  const auto one = hn::Set(di, 1);
  for (std::int64_t i = 0; i < n; i += lanes) {
    auto sum = hn::LoadU(d, out + i);
    const auto number = hn::Iota(d, static_cast<float>(i));
    for (std::int64_t k = 0; k < count; ++k) {
      const Tap& tap = taps[k];
      const auto place =
          hn::Min(hn::Max(hn::Add(hn::Set(d, tap.start), hn::Mul(hn::Set(d, tap.step), number)), zero), end);
      const auto index = hn::ConvertTo(di, place);
      const auto part = hn::Sub(place, hn::ConvertTo(d, index));
      const auto wa = hn::Set(d, tap.first_weight), wb = hn::Set(d, tap.second_weight);
      auto low = zero, high = zero;
      if (within_two_vectors(tap.step, lanes)) {
        const std::int64_t base = hn::GetLane(index);
        const float *a = tap.first + base, *b = tap.second + base;
        const auto near = hn::Add(hn::Mul(wa, hn::LoadU(d, a)), hn::Mul(wb, hn::LoadU(d, b)));
        const auto far = hn::Add(hn::Mul(wa, hn::LoadU(d, a + lanes)), hn::Mul(wb, hn::LoadU(d, b + lanes)));
        const auto from_base = hn::Sub(index, hn::Set(di, static_cast<std::int32_t>(base)));
        low = pick(d, near, far, from_base);
        high = pick(d, near, far, hn::Add(from_base, one));
      } else {
        low = hn::Add(hn::Mul(wa, hn::GatherIndex(d, tap.first, index)),
                      hn::Mul(wb, hn::GatherIndex(d, tap.second, index)));
        high = hn::Add(hn::Mul(wa, hn::GatherIndex(d, tap.first + 1, index)),
                       hn::Mul(wb, hn::GatherIndex(d, tap.second + 1, index)));
      }
      sum = hn::Add(sum, hn::Add(low, hn::Mul(part, hn::Sub(high, low))));
    }
    hn::StoreU(sum, d, out + i);
  }
}

// One butterfly of 16 rows: calls body(r) with the place of each vector.
template <class Body>
HWY_INLINE void for_rows(const Body& body) {
  const Wide d;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  for (std::int64_t r = 0; r < kLanes; r += lanes) body(r);
}

void Transform(const float* cosine, const float* sine, float* HWY_RESTRICT re, float* HWY_RESTRICT im,
               std::int64_t length) {
  const Wide d;
  for (std::int64_t half = length / 2; half >= 1; half /= 2) {
    const std::int64_t stride = length / (2 * half);
    for (std::int64_t block = 0; block < length; block += 2 * half)
      for (std::int64_t j = 0; j < half; ++j) {
        const auto c = hn::Set(d, cosine[j * stride]), s = hn::Set(d, sine[j * stride]);
        const std::int64_t a = (block + j) * kLanes, b = a + half * kLanes;
        for_rows([&](std::int64_t r) HWY_ATTR {
          const auto ar = hn::LoadU(d, re + a + r), ai = hn::LoadU(d, im + a + r);
          const auto br = hn::LoadU(d, re + b + r), bi = hn::LoadU(d, im + b + r);
          const auto dr = hn::Sub(ar, br), di = hn::Sub(ai, bi);
          hn::StoreU(hn::Add(ar, br), d, re + a + r);
          hn::StoreU(hn::Add(ai, bi), d, im + a + r);
          hn::StoreU(hn::Add(hn::Mul(dr, c), hn::Mul(di, s)), d, re + b + r);
          hn::StoreU(hn::Sub(hn::Mul(di, c), hn::Mul(dr, s)), d, im + b + r);
        });
      }
  }
}

void TransformBack(const float* cosine, const float* sine, float* HWY_RESTRICT re, float* HWY_RESTRICT im,
                   std::int64_t length) {
  const Wide d;
  for (std::int64_t half = 1; half < length; half *= 2) {
    const std::int64_t stride = length / (2 * half);
    for (std::int64_t block = 0; block < length; block += 2 * half)
      for (std::int64_t j = 0; j < half; ++j) {
        const auto c = hn::Set(d, cosine[j * stride]), s = hn::Set(d, sine[j * stride]);
        const std::int64_t a = (block + j) * kLanes, b = a + half * kLanes;
        for_rows([&](std::int64_t r) HWY_ATTR {
          const auto ar = hn::LoadU(d, re + a + r), ai = hn::LoadU(d, im + a + r);
          const auto xr = hn::LoadU(d, re + b + r), xi = hn::LoadU(d, im + b + r);
          const auto br = hn::Sub(hn::Mul(xr, c), hn::Mul(xi, s)), bi = hn::Add(hn::Mul(xi, c), hn::Mul(xr, s));
          hn::StoreU(hn::Add(ar, br), d, re + a + r);
          hn::StoreU(hn::Add(ai, bi), d, im + a + r);
          hn::StoreU(hn::Sub(ar, br), d, re + b + r);
          hn::StoreU(hn::Sub(ai, bi), d, im + b + r);
        });
      }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::phantom::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::phantom::kernels {

HWY_EXPORT(SumStraight);
HWY_EXPORT(SumMagnified);
HWY_EXPORT(Transform);
HWY_EXPORT(TransformBack);

void sum_straight(std::span<const Tap> taps, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(SumStraight)
  (taps.data(), static_cast<std::int64_t>(taps.size()), out.data(), static_cast<std::int64_t>(out.size()));
}
void sum_magnified(std::span<const Tap> taps, float last, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(SumMagnified)
  (taps.data(), static_cast<std::int64_t>(taps.size()), last, out.data(), static_cast<std::int64_t>(out.size()));
}
void transform(std::span<const float> cosine, std::span<const float> sine, std::span<float> real,
               std::span<float> imaginary) {
  HWY_DYNAMIC_DISPATCH(Transform)
  (cosine.data(), sine.data(), real.data(), imaginary.data(), static_cast<std::int64_t>(real.size()) / kLanes);
}
void transform_back(std::span<const float> cosine, std::span<const float> sine, std::span<float> real,
                    std::span<float> imaginary) {
  HWY_DYNAMIC_DISPATCH(TransformBack)
  (cosine.data(), sine.data(), real.data(), imaginary.data(), static_cast<std::int64_t>(real.size()) / kLanes);
}

}  // namespace dubsar::phantom::kernels
#endif
