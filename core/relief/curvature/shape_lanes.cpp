#include "core/relief/curvature/shape_lanes.h"

#include "core/relief/curvature/shape_class.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/relief/curvature/shape_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

std::size_t classify(const float* k_min, const float* k_max, std::size_t count, std::uint8_t* classes) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::Rebind<std::int64_t, decltype(d)> di;
  const hn::Rebind<std::uint64_t, decltype(d)> du;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  constexpr double kScale = 1.0 / (double{kSmallestCurvedness} * double{kSmallestCurvedness});
  // The exponent of a number, plus one where what it is multiplied with is at least the root of 2, is at these bits.
  constexpr std::uint64_t kBelowRoot = (std::uint64_t{1} << 52) - 0x6A09E667F3BCD;
  constexpr std::int64_t kBias = 1023;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    const auto a = hn::PromoteTo(d, hn::LoadU(df, k_min + i)), b = hn::PromoteTo(d, hn::LoadU(df, k_max + i));
    const auto finite = hn::And(hn::IsFinite(a), hn::IsFinite(b));
    const auto low = hn::Min(a, b), high = hn::Max(a, b);
    const auto size = hn::Mul(hn::Set(d, kScale), hn::Add(hn::Mul(low, low), hn::Mul(high, high)));
    const auto exponent = hn::ShiftRight<52>(hn::Add(hn::BitCast(du, size), hn::Set(du, kBelowRoot)));
    const auto step = hn::Sub(hn::BitCast(di, exponent), hn::Set(di, kBias));
    auto shape = hn::Zero(di);
    for (std::size_t j = 0; j < kShapeCosine.size(); ++j)
      shape = hn::Sub(shape, hn::BitCast(di, hn::VecFromMask(d, hn::Ge(hn::Mul(low, hn::Set(d, kShapeCosine[j])),
                                                                       hn::Mul(high, hn::Set(d, kShapeSine[j]))))));
    const auto nine = hn::IfThenElse(hn::Gt(step, hn::Set(di, 13)), hn::Set(di, 13), step);
    const auto number = hn::Add(hn::Add(hn::ShiftLeft<3>(nine), nine), hn::Add(shape, hn::Set(di, 1)));
    const auto curved = hn::And(hn::RebindMask(di, finite), hn::Gt(step, hn::Set(di, -1)));
    const auto found = hn::BitCast(du, hn::IfThenElseZero(curved, number));
    hn::StoreU(hn::TruncateTo(d8, found), d8, classes + i);
  }
  return i;
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(classify);
}  // namespace

std::size_t shape_class_lanes(const float* k_min, const float* k_max, std::size_t count,
                              std::uint8_t* classes) noexcept {
  static_assert(kShapes == 9);
  return HWY_DYNAMIC_DISPATCH(classify)(k_min, k_max, count, classes);
}

}  // namespace dubsar
#endif
