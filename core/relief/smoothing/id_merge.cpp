#include "core/relief/smoothing/id_merge.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/relief/smoothing/id_merge.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

std::size_t merge(const std::uint32_t* ids, std::size_t count, std::uint32_t* out) {
  const hn::CappedTag<std::uint32_t, kMergedIds> d;
  constexpr std::size_t kWidth = hn::MaxLanes(decltype(d)());
  std::uint32_t equal[kMergedIds], less[kMergedIds], firsts = 0;  // by number: which others are as large, are smaller
  for (std::size_t i = 0; i < count; ++i) {
    const auto own = hn::Set(d, ids[i]);
    equal[i] = less[i] = 0;
    for (std::size_t from = 0; from < kMergedIds; from += kWidth) {
      const auto others = hn::LoadU(d, ids + from);
      std::uint8_t bits[2][8] = {};
      hn::StoreMaskBits(d, hn::Eq(others, own), bits[0]);
      hn::StoreMaskBits(d, hn::Lt(others, own), bits[1]);
      std::uint16_t word;
      std::memcpy(&word, bits[0], sizeof word);
      equal[i] |= std::uint32_t{word} << from;
      std::memcpy(&word, bits[1], sizeof word);
      less[i] |= std::uint32_t{word} << from;
    }
    firsts |= ((equal[i] & ((1u << i) - 1)) == 0 ? 1u : 0u) << i;
  }
  // All of the same number are written to the same place.
  for (std::size_t i = 0; i < count; ++i)
    out[__builtin_popcount(less[i] & firsts)] =
        ids[i] | std::min(static_cast<std::uint32_t>(__builtin_popcount(equal[i])), 3u) << 30;
  return static_cast<std::size_t>(__builtin_popcount(firsts));
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(merge);
}  // namespace

std::size_t merge_ids(const std::uint32_t* ids, std::size_t count, std::uint32_t* out) {
  return HWY_DYNAMIC_DISPATCH(merge)(ids, count, out);
}

}  // namespace dubsar
#endif
