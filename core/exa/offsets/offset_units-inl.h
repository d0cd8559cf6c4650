// The units of an OffsetNetwork in vectors, once for each target of Highway: included behind <hwy/highway.h>.
#if defined(DUBSAR_OFFSET_UNITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUBSAR_OFFSET_UNITS_INL_H
#undef DUBSAR_OFFSET_UNITS_INL_H
#else
#define DUBSAR_OFFSET_UNITS_INL_H
#endif

#include <algorithm>
#include <cstring>

#include "core/exa/offsets/offset_model.h"

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
using Units = OffsetNetwork::Sums;
HWY_INLINE void load_units(const OffsetNetwork::Sums& sums, Units& units) { units = sums; }
HWY_INLINE void store_units(const Units& units, OffsetNetwork::Sums& sums) { sums = units; }
HWY_INLINE void add_pair(const OffsetNetwork::Pairs& weights, const std::int16_t* inputs, Units& units) {
  for (std::size_t u = 0; u < kOffsetUnits; ++u)
    units[u] += std::int32_t{weights[u][0]} * inputs[0] + std::int32_t{weights[u][1]} * inputs[1];
}
HWY_INLINE void weigh(const OffsetNetwork& network, const Units& units, std::int32_t* totals) {
  totals[0] = totals[1] = 0;
  for (std::size_t u = 0; u < kOffsetUnits; ++u)
    for (std::size_t o = 0; o < 2; ++o) totals[o] += std::clamp(units[u] >> 7, 0, 8191) * network.out[o][u][0];
}
#else
using D = hn::CappedTag<std::int32_t, 16>;
constexpr std::size_t kUnitLanes = hn::MaxLanes(D()), kVectors = (kOffsetUnits + kUnitLanes - 1) / kUnitLanes;
struct Units {
  hn::Vec<D> even[kVectors], odd[kVectors];
};
HWY_INLINE void load_units(const OffsetNetwork::Sums& sums, Units& units) {
  const D d;
  for (std::size_t v = 0; v < kVectors; ++v) {
    units.even[v] = hn::Load(d, sums.data() + v * kUnitLanes);
    units.odd[v] = hn::Zero(d);
  }
}
HWY_INLINE void store_units(const Units& units, OffsetNetwork::Sums& sums) {
  for (std::size_t v = 0; v < kVectors; ++v)
    hn::Store(hn::RearrangeToOddPlusEven(units.even[v], units.odd[v]), D(), sums.data() + v * kUnitLanes);
}
/// One pair of inputs for all units.
HWY_INLINE void add_pair(const OffsetNetwork::Pairs& weights, const std::int16_t* inputs, Units& units) {
  const D d;
  const hn::Repartition<std::int16_t, D> d16;
  std::int32_t pair;
  std::memcpy(&pair, inputs, sizeof pair);
  const auto same = hn::BitCast(d16, hn::Set(d, pair));
  for (std::size_t v = 0; v < kVectors; ++v)
    units.even[v] = hn::ReorderWidenMulAccumulate(d, hn::LoadU(d16, weights[v * kUnitLanes].data()), same,
                                                  units.even[v], units.odd[v]);
}
HWY_INLINE void weigh(const OffsetNetwork& network, const Units& units, std::int32_t* totals) {
  const D d;
  const hn::Repartition<std::int16_t, D> d16;
  auto mean = hn::Zero(d), mean_odd = hn::Zero(d), spread = hn::Zero(d), spread_odd = hn::Zero(d);
  for (std::size_t v = 0; v < kVectors; ++v) {
    const auto sum = hn::ShiftRight<7>(hn::RearrangeToOddPlusEven(units.even[v], units.odd[v]));
    const auto unit = hn::BitCast(d16, hn::Min(hn::Max(sum, hn::Zero(d)), hn::Set(d, 8191)));  // 13 bits and 0
    mean =
        hn::ReorderWidenMulAccumulate(d, unit, hn::LoadU(d16, network.out[0][v * kUnitLanes].data()), mean, mean_odd);
    spread = hn::ReorderWidenMulAccumulate(d, unit, hn::LoadU(d16, network.out[1][v * kUnitLanes].data()), spread,
                                           spread_odd);
  }
  totals[0] = hn::GetLane(hn::SumOfLanes(d, hn::Add(mean, mean_odd)));
  totals[1] = hn::GetLane(hn::SumOfLanes(d, hn::Add(spread, spread_odd)));
}
#endif

HWY_INLINE OffsetEstimate estimate(const OffsetNetwork& network, const Units& units) {
  std::int32_t totals[2];
  weigh(network, units, totals);
  return {std::clamp(((totals[0] >> 7) + network.out_bias[0] + 4) >> 3, -128, 127),
          std::clamp(((totals[1] >> 9) + network.out_bias[1]) >> 6, 0, 31)};
}

/// Of sums without the two columns of the row itself, and those.
HWY_INLINE OffsetEstimate estimate_near(const OffsetNetwork& network, const OffsetNetwork::Sums& sums,
                                        const OffsetNear& near) {
  Units units;
  load_units(sums, units);
  for (std::size_t c = 0; c < 2; ++c) add_pair(network.near[c], near[c].data(), units);
  return estimate(network, units);
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
