// Rows of floats into vectors, once for each target of Highway: included behind <hwy/highway.h>.
#if defined(DUBSAR_ROW_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUBSAR_ROW_LANES_INL_H
#undef DUBSAR_ROW_LANES_INL_H
#else
#define DUBSAR_ROW_LANES_INL_H
#endif

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {

template <class V>
struct RowLanes {
  V x, y, z, w;
};

/// Lane l: the four floats at from(l).
#if HWY_TARGET == HWY_SCALAR
template <class Tag, class From>
HWY_INLINE RowLanes<hwy::HWY_NAMESPACE::Vec<Tag>> load_rows(Tag d, const From& from) {
  const float* row = from(std::size_t{0});
  namespace hn = hwy::HWY_NAMESPACE;
  return {hn::Set(d, row[0]), hn::Set(d, row[1]), hn::Set(d, row[2]), hn::Set(d, row[3])};
}
#else
template <class Tag, class From>
HWY_INLINE RowLanes<hwy::HWY_NAMESPACE::Vec<Tag>> load_rows(Tag d, const From& from) {
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr std::size_t kWidth = hn::MaxLanes(Tag());
  static_assert(kWidth == 4 || kWidth == 8 || kWidth == 16);
  const hn::FixedTag<hn::TFromD<Tag>, 4> d4;
  const auto row = [&](std::size_t i) HWY_ATTR {  // lanes i, i + 4, ... one per 128-bit block
    if constexpr (kWidth == 4) {
      return hn::LoadU(d4, from(i));
    } else {
      const hn::FixedTag<hn::TFromD<Tag>, 8> d8;
      const auto low = hn::Combine(d8, hn::LoadU(d4, from(i + 4)), hn::LoadU(d4, from(i)));
      if constexpr (kWidth == 8)
        return low;
      else
        return hn::Combine(d, hn::Combine(d8, hn::LoadU(d4, from(i + 12)), hn::LoadU(d4, from(i + 8))), low);
    }
  };
  const hn::RepartitionToWide<Tag> d2;
  const auto r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
  const auto xy01 = hn::BitCast(d2, hn::InterleaveLower(d, r0, r1));
  const auto xy23 = hn::BitCast(d2, hn::InterleaveLower(d, r2, r3));
  const auto zw01 = hn::BitCast(d2, hn::InterleaveUpper(d, r0, r1));
  const auto zw23 = hn::BitCast(d2, hn::InterleaveUpper(d, r2, r3));
  return {hn::BitCast(d, hn::InterleaveLower(d2, xy01, xy23)), hn::BitCast(d, hn::InterleaveUpper(d2, xy01, xy23)),
          hn::BitCast(d, hn::InterleaveLower(d2, zw01, zw23)), hn::BitCast(d, hn::InterleaveUpper(d2, zw01, zw23))};
}
#endif

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // DUBSAR_ROW_LANES_INL_H
