#include "core/exa/coding/crc_fold.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/exa/coding/crc_fold.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL || HWY_TARGET == HWY_AVX3_ZEN4
using D = hn::FixedTag<std::uint64_t, 2>;
using V = hn::Vec<D>;

HWY_INLINE V load(const std::uint8_t* from) {
  return hn::BitCast(D(), hn::LoadU(hn::FixedTag<std::uint8_t, 16>(), from));
}
/// x moved on by as many bits as `by` stands for, over `next`.
HWY_INLINE V folded(V x, V by, V next) { return hn::Xor(hn::Xor(hn::CLMulLower(x, by), hn::CLMulUpper(x, by)), next); }

bool fold(const std::uint8_t* from, std::size_t size, std::uint32_t state, FoldedCrc& result) {
  const D d;
  // x^n modulo the polynomial, reflected, for n = 4 * 128 + 32 and - 32, then 128 + 32 and - 32.
  alignas(16) static constexpr std::uint64_t kFour[2] = {0x0154442bd4, 0x01c6e41596},
                                             kOne[2] = {0x01751997d0, 0x00ccaa009e};
  const V four = hn::Load(d, kFour), one = hn::Load(d, kOne);
  alignas(16) const std::uint64_t start[2] = {state, 0};
  V x0 = hn::Xor(load(from), hn::Load(d, start)), x1 = load(from + 16), x2 = load(from + 32), x3 = load(from + 48);
  for (std::size_t at = 64; at < size; at += 64) {
    x0 = folded(x0, four, load(from + at));
    x1 = folded(x1, four, load(from + at + 16));
    x2 = folded(x2, four, load(from + at + 32));
    x3 = folded(x3, four, load(from + at + 48));
  }
  const V all = folded(folded(folded(x0, one, x1), one, x2), one, x3);
  hn::StoreU(hn::BitCast(hn::FixedTag<std::uint8_t, 16>(), all), hn::FixedTag<std::uint8_t, 16>(), result.bytes);
  return true;
}
#else
bool fold(const std::uint8_t*, std::size_t, std::uint32_t, FoldedCrc&) { return false; }
#endif

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(fold);
}  // namespace

bool fold_crc(const std::uint8_t* from, std::size_t size, std::uint32_t state, FoldedCrc& folded) noexcept {
  return HWY_DYNAMIC_DISPATCH(fold)(from, size, state, folded);
}

}  // namespace dubsar
#endif
