#include "core/contact/kernels/dip_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/kernels/dip_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kDipRow>;
using Ints = hn::Rebind<std::int32_t, Floats>;

/// Clay at both ends of an arm of points from a place on?
auto clay_beside(const std::int32_t* clay, std::int32_t place, std::int32_t arm) {
  const Ints ints;
  const auto both = hn::And(hn::LoadU(ints, clay + place + arm), hn::LoadU(ints, clay + place - arm));
  return hn::RebindMask(Floats(), hn::Ne(both, hn::Zero(ints)));
}

auto meant_for(const DipRow& row, std::int32_t i, const DipDirection& d, const std::int32_t* clay) {
  const Floats floats;
  const auto part = [&](std::size_t axis) {
    return hn::Mul(hn::Set(floats, d.unit[axis]), hn::LoadU(floats, row.normal[axis].data() + i));
  };
  const auto cosine = hn::Add(hn::Add(part(0), part(1)), part(2));
  return hn::And(hn::Ge(hn::Abs(cosine), hn::Set(floats, d.least_cosine)), clay_beside(clay, row.place + i, d.arms[0]));
}

std::size_t rows_across(std::span<const DipRow> rows, const DipDirection& d, const std::int32_t* clay,
                        std::uint32_t* found) {
  const Floats floats;
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(floats));
  std::size_t count = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    bool any = false;
    for (std::int32_t i = 0; i < kDipRow; i += lanes) any |= !hn::AllFalse(floats, meant_for(rows[r], i, d, clay));
    found[count] = static_cast<std::uint32_t>(r);
    count += any;
  }
  return count;
}

void raise_dips(std::span<DipRow> rows, std::span<const std::uint32_t> some, const DipDirection& d,
                const std::int32_t* clay, const float* means) {
  const Floats floats;
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(floats));
  const auto two = hn::Set(floats, 2.0f);
  for (const std::uint32_t r : some)
    for (std::int32_t i = 0; i < kDipRow; i += lanes) {
      DipRow& row = rows[r];
      const std::int32_t at = row.place + i;
      const auto both = [&](std::int32_t arm) {
        return hn::Add(hn::LoadU(floats, means + at + arm), hn::LoadU(floats, means + at - arm));
      };
      auto sum = both(d.arms[0]), disks = two;
      for (std::size_t arm = 1; arm < kDipArms; ++arm) {
        const auto there = clay_beside(clay, at, d.arms[arm]);
        sum = hn::Add(sum, hn::IfThenElseZero(there, both(d.arms[arm])));
        disks = hn::Add(disks, hn::IfThenElseZero(there, two));
      }
      const auto middle = hn::LoadU(floats, means + at), dip = hn::Sub(hn::Div(sum, disks), middle),
                 before = hn::LoadU(floats, row.strength.data() + i);
      const auto stronger = hn::And(meant_for(row, i, d, clay), hn::Gt(dip, before));
      hn::StoreU(hn::IfThenElse(stronger, dip, before), floats, row.strength.data() + i);
      hn::StoreU(hn::IfThenElse(stronger, middle, hn::LoadU(floats, row.density.data() + i)), floats,
                 row.density.data() + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(rows_across);
HWY_EXPORT(raise_dips);
}  // namespace

std::size_t rows_across(std::span<const DipRow> rows, const DipDirection& direction, const std::int32_t* clay,
                        std::uint32_t* found) {
  return HWY_DYNAMIC_DISPATCH(rows_across)(rows, direction, clay, found);
}
void raise_dips(std::span<DipRow> rows, std::span<const std::uint32_t> some, const DipDirection& direction,
                const std::int32_t* clay, const float* means) {
  HWY_DYNAMIC_DISPATCH(raise_dips)(rows, some, direction, clay, means);
}

}  // namespace dubsar
#endif
