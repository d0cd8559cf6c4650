#include "core/contact/kernels/row_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/kernels/row_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Of kRows rows at once, whose sums do not wait for each other.
template <std::size_t kRows>
void sum_some(const float* from, std::span<const RowTap> taps, const SummedRow* rows, float* to) {
  const hn::CappedTag<float, kRowLength> d;
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
  for (std::int32_t i = 0; i < kRowLength; i += lanes) {
    const float* const in = from + i;
    auto a = hn::Zero(d), b = a, c = a, e = a;
    for (const RowTap& tap : taps) {
      const auto weight = hn::Set(d, tap.weight);
      const float* const at = in + tap.away;
      a = hn::Add(a, hn::Mul(weight, hn::LoadU(d, at + rows[0].from)));
      if constexpr (kRows > 1) {
        b = hn::Add(b, hn::Mul(weight, hn::LoadU(d, at + rows[1].from)));
        c = hn::Add(c, hn::Mul(weight, hn::LoadU(d, at + rows[2].from)));
        e = hn::Add(e, hn::Mul(weight, hn::LoadU(d, at + rows[3].from)));
      }
    }
    hn::StoreU(a, d, to + rows[0].to + i);
    if constexpr (kRows > 1) {
      hn::StoreU(b, d, to + rows[1].to + i);
      hn::StoreU(c, d, to + rows[2].to + i);
      hn::StoreU(e, d, to + rows[3].to + i);
    }
  }
}

void sum_rows(const float* from, std::span<const RowTap> taps, std::span<const SummedRow> rows, float* to) {
  std::size_t r = 0;
  for (; r + 4 <= rows.size(); r += 4) sum_some<4>(from, taps, rows.data() + r, to);
  for (; r < rows.size(); ++r) sum_some<1>(from, taps, rows.data() + r, to);
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
