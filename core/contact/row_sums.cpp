#include "core/contact/row_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/row_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void sum_rows(const float* from, std::span<const RowTap> taps, std::span<const SummedRow> rows, float* to) {
  const hn::CappedTag<float, kRowLength> d;
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
  for (const SummedRow& row : rows)
    for (std::int32_t i = 0; i < kRowLength; i += lanes) {
      const float* const in = from + row.from + i;
      auto sum = hn::Zero(d);
      for (const RowTap& tap : taps) sum = hn::Add(sum, hn::Mul(hn::Set(d, tap.weight), hn::LoadU(d, in + tap.away)));
      hn::StoreU(sum, d, to + row.to + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(sum_rows);
}  // namespace

void sum_rows(const float* from, std::span<const RowTap> taps, std::span<const SummedRow> rows, float* to) {
  HWY_DYNAMIC_DISPATCH(sum_rows)(from, taps, rows, to);
}

}  // namespace dubsar
#endif
