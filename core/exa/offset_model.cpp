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

/// Sums of units times weights for mean and spread. Integers: the same on every target.
#if HWY_TARGET == HWY_SCALAR
void weigh(const OffsetModel::Axis& axis, const OffsetInputs& inputs, std::int32_t* sums) {
  sums[0] = sums[1] = 0;
  for (std::size_t u = 0; u < kOffsetUnits; ++u) {
    std::int32_t sum = axis.bias[u];
    for (std::size_t i = 0; i < inputs.size(); ++i) sum += std::int32_t{axis.in[i / 2][u][i % 2]} * inputs[i];
    const std::int32_t unit = std::clamp(sum >> 7, 0, 8191);
    for (std::size_t o = 0; o < 2; ++o) sums[o] += unit * axis.out[o][u];
  }
}
#else
void weigh(const OffsetModel::Axis& axis, const OffsetInputs& inputs, std::int32_t* sums) {
  const hn::CappedTag<std::int32_t, 8> d;
  const hn::Repartition<std::int16_t, decltype(d)> d16;
  constexpr std::size_t kWidth = hn::MaxLanes(decltype(d)()), kVectors = kOffsetUnits / kWidth;
  hn::Vec<decltype(d)> even[kVectors], odd[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) {
    even[v] = hn::Load(d, axis.bias.data() + v * kWidth);
    odd[v] = hn::Zero(d);
  }
  for (std::size_t p = 0; p < axis.in.size(); ++p) {  // one pair of inputs for all units at a time
    std::int32_t pair;
    std::memcpy(&pair, inputs.data() + 2 * p, sizeof pair);
    const auto both = hn::BitCast(d16, hn::Set(d, pair));
    for (std::size_t v = 0; v < kVectors; ++v)
      even[v] = hn::ReorderWidenMulAccumulate(d, hn::Load(d16, axis.in[p][v * kWidth].data()), both, even[v], odd[v]);
  }
  auto mean = hn::Zero(d), spread = hn::Zero(d);
  for (std::size_t v = 0; v < kVectors; ++v) {
    auto unit = hn::ShiftRight<7>(hn::RearrangeToOddPlusEven(even[v], odd[v]));
    unit = hn::Min(hn::Max(unit, hn::Zero(d)), hn::Set(d, 8191));
    mean = hn::Add(mean, hn::Mul(unit, hn::Load(d, axis.out[0].data() + v * kWidth)));
    spread = hn::Add(spread, hn::Mul(unit, hn::Load(d, axis.out[1].data() + v * kWidth)));
  }
  sums[0] = hn::GetLane(hn::SumOfLanes(d, mean));
  sums[1] = hn::GetLane(hn::SumOfLanes(d, spread));
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
HWY_EXPORT(weigh);
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
  for (Axis& axis : axes_) {
    for (std::size_t u = 0; u < kOffsetUnits; ++u)
      for (std::size_t i = 0; i < kOffsetInputs; ++i) axis.in[i / 2][u][i % 2] = *weights++;
    for (std::int32_t& v : axis.bias) v = 128 * *weights++;
    for (auto& row : axis.out)
      for (std::int32_t& v : row) v = *weights++;
    for (std::int32_t& v : axis.out_bias) v = *weights++;
  }
}

const OffsetModel& OffsetModel::instance(std::size_t which) {
  static const std::array<OffsetModel, kOffsetModels> models{OffsetModel(kOffsetWeightsScan),
                                                             OffsetModel(kOffsetWeightsSmooth)};
  return models[which];
}

OffsetEstimate OffsetModel::predict(int axis_index, const OffsetInputs& inputs) const noexcept {
  const Axis& axis = axes_[static_cast<std::size_t>(axis_index)];
  std::array<std::int32_t, 2> sums;
  HWY_DYNAMIC_DISPATCH(weigh)(axis, inputs, sums.data());
  return {std::clamp(((sums[0] >> 7) + axis.out_bias[0] + 4) >> 3, -128, 127),
          std::clamp(((sums[1] >> 9) + axis.out_bias[1]) >> 6, 0, 31)};
}

}  // namespace dubsar
#endif
