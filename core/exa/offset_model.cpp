#include "core/exa/offset_model.h"

#include <algorithm>

namespace dubsar {
namespace {
#include "core/exa/offset_weights.inc"
}  // namespace

OffsetModel::OffsetModel(const std::int16_t* weights) {
  for (Axis& axis : axes_) {
    for (OffsetInputs& unit : axis.in)
      for (std::size_t i = 0; i < kOffsetInputs; ++i) unit[i] = *weights++;
    for (std::int16_t& v : axis.bias) v = *weights++;
    for (auto& row : axis.out)
      for (std::int16_t& v : row) v = *weights++;
    for (std::int16_t& v : axis.out_bias) v = *weights++;
  }
}

const OffsetModel& OffsetModel::instance(std::size_t which) {
  static const std::array<OffsetModel, kOffsetModels> models{OffsetModel(kOffsetWeightsScan),
                                                             OffsetModel(kOffsetWeightsSmooth)};
  return models[which];
}

OffsetDistribution OffsetModel::predict(int axis_index, const OffsetInputs& inputs, int bits) const noexcept {
  const Axis& axis = axes_[static_cast<std::size_t>(axis_index)];
  std::int32_t mean = 0, spread = 0;
  for (std::size_t u = 0; u < kOffsetUnits; ++u) {
    std::int32_t sum = axis.bias[u] * 128;
    for (std::size_t i = 0; i < inputs.size(); ++i) sum += std::int32_t{axis.in[u][i]} * inputs[i];
    const std::int32_t unit = std::clamp(sum >> 7, 0, 8191);
    mean += unit * axis.out[0][u];
    spread += unit * axis.out[1][u];
  }
  return {8 * std::clamp(((mean >> 7) + axis.out_bias[0] + 4) >> 3, -128, 127), std::clamp(((spread >> 9) + axis.out_bias[1]) >> 6, 0, 31), bits};
}

}  // namespace dubsar
