// Offsets of 4 bits, a row of edges at a time: the serial part of decoding, with as few steps from one to the next as
// there can be.
#include "core/exa/offsets/offset_kernels.h"
#include "core/exa/offsets/offset_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/exa/offsets/offset_decode_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/exa/offsets/offset_units-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {

/// How many of the 16 starts, each times `unit`, are at most `code`: without a division.
HWY_INLINE std::uint32_t count_starts(const OffsetTable::Starts& starts, std::uint32_t unit, std::uint32_t code) {
#if HWY_TARGET == HWY_SCALAR
  std::uint32_t count = 0;
  for (const std::uint16_t start : starts) count += unit * start <= code ? 1 : 0;
  return count;
#else
  const hn::CappedTag<std::uint32_t, 16> d32;
  const hn::Rebind<std::uint16_t, decltype(d32)> d16;
  constexpr std::size_t kWidth = hn::MaxLanes(decltype(d32)());
  const auto units = hn::Set(d32, unit), codes = hn::Set(d32, code);
  std::size_t above = 0;
  for (std::size_t k = 0; k < 16; k += kWidth)
    above += hn::CountTrue(d32, hn::Gt(hn::Mul(hn::PromoteTo(d32, hn::LoadU(d16, starts.data() + k)), units), codes));
  return static_cast<std::uint32_t>(16 - above);
#endif
}

void decode_row(const OffsetNetwork& network, int axis, std::span<const std::uint8_t> xs, const OffsetRow& row,
                RangeDecoder& in, std::uint8_t* known, std::uint16_t* offsets) {
  const OffsetTable& table = OffsetTable::instance();
  RangeDecoder own = in;  // in registers
  OffsetsBefore before;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const int x = xs[i];
    OffsetEstimate likely = row.estimates[i];
    OffsetNear near{};
    if (axis != 0 && before.near(x, row.own[i] != 0, near)) likely = estimate_near(network, row.sums[i], near);
    const OffsetTable::Starts& starts = table.starts(likely);
    const std::uint32_t unit = own.split(), symbol = count_starts(starts, unit, own.code()) - 1;
    own.symbol(starts[symbol], OffsetTable::end(starts, symbol) - starts[symbol]);
    const int middle = static_cast<int>(4 * symbol + 2);
    offsets[i] = static_cast<std::uint16_t>(symbol);
    known[x] = static_cast<std::uint8_t>(1 + middle);
    before.note(x, row.own[i] != 0, middle);
  }
  in = own;
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(decode_row);
}  // namespace

void decode_offset_row(const OffsetNetwork& network, int axis, std::span<const std::uint8_t> xs, const OffsetRow& row,
                       RangeDecoder& in, std::uint8_t* known, std::uint16_t* offsets) {
  HWY_DYNAMIC_DISPATCH(decode_row)(network, axis, xs, row, in, known, offsets);
}

}  // namespace dubsar
#endif
