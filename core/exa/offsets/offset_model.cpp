#include "core/exa/offsets/offset_model.h"

#include <algorithm>

#include "core/exa/offsets/offset_kernels.h"

namespace dubsar {
namespace {
#include "core/exa/offsets/offset_weights.inc"

/// Logit steps (1 / 256) per 1 / 1024 grid step, times 256: 2^16 / (16 * 2^(s / 4)) for spread s, rounded.
constexpr std::array<std::int32_t, 32> kSteepness{4096, 3444, 2896, 2435, 2048, 1722, 1448, 1218, 1024, 861, 724,
                                                  609,  512,  431,  362,  304,  256,  215,  181,  152,  128, 108,
                                                  91,   76,   64,   54,   45,   38,   32,   27,   23,   19};
/// Which of the documented columns lies one (c = 0) or two steps before an edge along x.
constexpr std::size_t row_column(std::size_t axis, std::size_t c) { return (axis == 1 ? 2 : 0) + 8 * c; }
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
    OffsetNetwork& network = axes_[a];
    const OffsetLayout& layout = kOffsetLayouts[a];
    for (std::size_t u = 0; u < kOffsetUnits; ++u, weights += kOffsetInputs) {
      for (std::size_t i = 0; i < layout.inputs(); ++i)
        network.in[i / 2][u][i % 2] = weights[documented_input(layout, i)];
      for (std::size_t c = 0; a > 0 && c < 2; ++c)
        network.near[c][u] = {weights[3 * row_column(a, c)], weights[3 * row_column(a, c) + 2]};
    }
    for (std::size_t u = 0; u < kOffsetUnits; ++u) network.bias[u] = 128 * *weights++;
    for (auto& row : network.out)
      for (std::size_t u = 0; u < kOffsetUnits; ++u) row[u][0] = *weights++;
    for (std::int32_t& v : network.out_bias) v = *weights++;
  }
}

const OffsetModel& OffsetModel::instance(std::size_t which) {
  static const std::array<OffsetModel, kOffsetModels> models{OffsetModel(kOffsetWeightsScan),
                                                             OffsetModel(kOffsetWeightsSmooth)};
  return models[which];
}

void OffsetModel::begin(int axis, const OffsetPlace& place, std::span<const std::uint8_t> xs,
                        OffsetRow& row) const noexcept {
  begin_offsets(axes_[static_cast<std::size_t>(axis)], axis, place, xs, row);
}

OffsetEstimate OffsetModel::finish(int axis, const OffsetNetwork::Sums& sums, const OffsetNear& near) const noexcept {
  return finish_offset(axes_[static_cast<std::size_t>(axis)], sums, near);
}

void OffsetModel::decode(int axis, std::span<const std::uint8_t> xs, const OffsetRow& row, RangeDecoder& in,
                         std::uint8_t* known, std::uint16_t* offsets) const noexcept {
  decode_offset_row(axes_[static_cast<std::size_t>(axis)], axis, xs, row, in, known, offsets);
}

}  // namespace dubsar
