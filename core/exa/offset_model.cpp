#include "core/exa/offset_model.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/exa/offset_model.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// Integers: the same on every target.
#if HWY_TARGET == HWY_SCALAR
void begin_units(const OffsetModel::Axis& axis, std::span<const OffsetInputs> inputs, OffsetModel::Sums* sums) {
  for (const OffsetInputs& input : inputs) {
    for (std::size_t u = 0; u < kOffsetUnits; ++u) {
      std::int32_t sum = axis.bias[u];
      for (std::size_t i = 0; i < input.size(); ++i) sum += std::int32_t{axis.in[i / 2][u][i % 2]} * input[i];
      (*sums)[u] = sum;
    }
    ++sums;
  }
}
void finish_units(const OffsetModel::Axis& axis, const OffsetModel::Sums& sums, const OffsetNear& near,
                  std::int32_t* totals) {
  totals[0] = totals[1] = 0;
  for (std::size_t u = 0; u < kOffsetUnits; ++u) {
    std::int32_t sum = sums[u];
    for (std::size_t i = 0; i < 4; ++i) sum += std::int32_t{axis.near[i / 2][u][i % 2]} * near[i / 2][i % 2];
    const std::int32_t unit = std::clamp(sum >> 7, 0, 8191);
    for (std::size_t o = 0; o < 2; ++o) totals[o] += unit * axis.out[o][u][0];
  }
}
#else
using D = hn::CappedTag<std::int32_t, 8>;
constexpr std::size_t kWidth = hn::MaxLanes(D()), kVectors = kOffsetUnits / kWidth;

/// One pair of inputs for all units.
HWY_INLINE void add_pair(const OffsetModel::Pairs& weights, const std::int16_t* inputs, hn::Vec<D>* even,
                         hn::Vec<D>* odd) {
  const D d;
  const hn::Repartition<std::int16_t, D> d16;
  std::int32_t pair;
  std::memcpy(&pair, inputs, sizeof pair);
  const auto both = hn::BitCast(d16, hn::Set(d, pair));
  for (std::size_t v = 0; v < kVectors; ++v)
    even[v] = hn::ReorderWidenMulAccumulate(d, hn::LoadU(d16, weights[v * kWidth].data()), both, even[v], odd[v]);
}

void begin_units(const OffsetModel::Axis& axis, std::span<const OffsetInputs> inputs, OffsetModel::Sums* sums) {
  const D d;
  for (const OffsetInputs& input : inputs) {
    hn::Vec<D> even[kVectors], odd[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      even[v] = hn::Load(d, axis.bias.data() + v * kWidth);
      odd[v] = hn::Zero(d);
    }
    for (std::size_t p = 0; p < axis.in.size(); ++p) add_pair(axis.in[p], input.data() + 2 * p, even, odd);
    for (std::size_t v = 0; v < kVectors; ++v)
      hn::Store(hn::RearrangeToOddPlusEven(even[v], odd[v]), d, sums->data() + v * kWidth);
    ++sums;
  }
}

void finish_units(const OffsetModel::Axis& axis, const OffsetModel::Sums& sums, const OffsetNear& near,
                  std::int32_t* totals) {
  const D d;
  const hn::Repartition<std::int16_t, D> d16;
  hn::Vec<D> even[kVectors], odd[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) {
    even[v] = hn::Load(d, sums.data() + v * kWidth);
    odd[v] = hn::Zero(d);
  }
  for (std::size_t c = 0; c < 2; ++c) add_pair(axis.near[c], near[c].data(), even, odd);
  auto mean = hn::Zero(d), mean_odd = hn::Zero(d), spread = hn::Zero(d), spread_odd = hn::Zero(d);
  for (std::size_t v = 0; v < kVectors; ++v) {
    const auto sum = hn::ShiftRight<7>(hn::RearrangeToOddPlusEven(even[v], odd[v]));
    const auto unit = hn::BitCast(d16, hn::Min(hn::Max(sum, hn::Zero(d)), hn::Set(d, 8191)));  // 13 bits and 0
    mean = hn::ReorderWidenMulAccumulate(d, unit, hn::LoadU(d16, axis.out[0][v * kWidth].data()), mean, mean_odd);
    spread = hn::ReorderWidenMulAccumulate(d, unit, hn::LoadU(d16, axis.out[1][v * kWidth].data()), spread, spread_odd);
  }
  totals[0] = hn::GetLane(hn::SumOfLanes(d, hn::Add(mean, mean_odd)));
  totals[1] = hn::GetLane(hn::SumOfLanes(d, hn::Add(spread, spread_odd)));
}
#endif

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
#include "core/exa/offset_weights.inc"

/// Logit steps (1 / 256) per 1 / 1024 grid step, times 256: 2^16 / (16 * 2^(s / 4)) for spread s, rounded.
constexpr std::array<std::int32_t, 32> kSteepness{4096, 3444, 2896, 2435, 2048, 1722, 1448, 1218, 1024, 861, 724,
                                                  609,  512,  431,  362,  304,  256,  215,  181,  152,  128, 108,
                                                  91,   76,   64,   54,   45,   38,   32,   27,   23,   19};
/// Which of the columns (offset_window.cpp) lies one (c = 0) or two steps before an edge along x.
constexpr std::size_t row_column(std::size_t axis, std::size_t c) { return (axis == 1 ? 2 : 0) + 8 * c; }

HWY_EXPORT(begin_units);
HWY_EXPORT(finish_units);
}  // namespace

std::uint32_t OffsetDistribution::start(std::uint32_t k) const noexcept {
  if (k == 0) return 0;
  const std::uint32_t symbols = 1u << bits_;
  if (k == symbols) return 1u << 16;
  const std::int64_t distance = (std::int64_t{k} << (10 - bits_)) - 512 - 8 * estimate_.mean;
  const std::int64_t logit = distance * kSteepness[static_cast<std::size_t>(estimate_.spread)] >> 8;
  const std::uint32_t below = probability_of(static_cast<int>(logit < -2048 ? -2048 : logit > 2047 ? 2047 : logit));
  return (below * (65536 - 32 * symbols) >> 16) + 32 * k;
}

OffsetTable::OffsetTable() : rows_(32 * 256) {
  for (int spread = 0; spread < 32; ++spread)
    for (int mean = -128; mean < 128; ++mean) {
      const OffsetDistribution exact({mean, spread}, kBits);
      Starts& row = rows_[static_cast<std::size_t>(spread) * 256 + static_cast<std::size_t>(mean + 128)];
      for (std::uint32_t k = 0; k < 16; ++k) row[k] = static_cast<std::uint16_t>(exact.start(k));
    }
}

const OffsetTable& OffsetTable::instance() {
  static const OffsetTable table;
  return table;
}

OffsetModel::OffsetModel(const std::int16_t* weights) {
  for (std::size_t a = 0; a < 3; ++a) {
    Axis& axis = axes_[a];
    for (std::size_t u = 0; u < kOffsetUnits; ++u)
      for (std::size_t i = 0; i < kOffsetInputs; ++i) axis.in[i / 2][u][i % 2] = *weights++;
    for (std::int32_t& v : axis.bias) v = 128 * *weights++;
    for (auto& row : axis.out)
      for (auto& pair : row) pair[0] = *weights++;
    for (std::int32_t& v : axis.out_bias) v = *weights++;
    for (std::size_t c = 0; a > 0 && c < 2; ++c) {
      const std::size_t value = 3 * row_column(a, c), known = value + 2;
      for (std::size_t u = 0; u < kOffsetUnits; ++u)
        axis.near[c][u] = {axis.in[value / 2][u][value % 2], axis.in[known / 2][u][known % 2]};
    }
  }
}

const OffsetModel& OffsetModel::instance(std::size_t which) {
  static const std::array<OffsetModel, kOffsetModels> models{OffsetModel(kOffsetWeightsScan),
                                                             OffsetModel(kOffsetWeightsSmooth)};
  return models[which];
}

void OffsetModel::begin(int axis, std::span<const OffsetInputs> inputs, Sums* sums) const noexcept {
  HWY_DYNAMIC_DISPATCH(begin_units)(axes_[static_cast<std::size_t>(axis)], inputs, sums);
}

OffsetEstimate OffsetModel::finish(int axis_index, const Sums& sums, const OffsetNear& near) const noexcept {
  const Axis& axis = axes_[static_cast<std::size_t>(axis_index)];
  std::array<std::int32_t, 2> totals;
  HWY_DYNAMIC_DISPATCH(finish_units)(axis, sums, near, totals.data());
  return {std::clamp(((totals[0] >> 7) + axis.out_bias[0] + 4) >> 3, -128, 127),
          std::clamp(((totals[1] >> 9) + axis.out_bias[1]) >> 6, 0, 31)};
}

}  // namespace dubsar
#endif
