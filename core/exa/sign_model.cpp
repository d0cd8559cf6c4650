#include "core/exa/sign_model.h"

#include <algorithm>

namespace dubsar {
namespace {
#include "core/exa/sign_weights.inc"
}  // namespace

std::vector<SignTap> sign_taps(int phase) {
  const auto place = [](int kind) {
    return kind == 0 ? -1 : std::find(kSignPhases.begin(), kSignPhases.end(), kind) - kSignPhases.begin();
  };
  std::vector<SignTap> taps;
  for (int z = -3; z <= 3; ++z)
    for (int y = -3; y <= 3; ++y)
      for (int x = -3; x <= 3; ++x) {
        if (x * x + y * y + z * z > kSignReach2) continue;
        const int kind = phase ^ ((x & 1) | (y & 1) << 1 | (z & 1) << 2);
        const bool before = z < 0 || (z == 0 && (y < 0 || (y == 0 && x < 0)));
        if (place(kind) < place(phase) || (kind == phase && before)) taps.push_back({x, y, z});
      }
  return taps;
}

SignModel::SignModel(const std::array<SignWeights, 7>& weights) {
  for (std::size_t p = 0; p < 7; ++p) {
    const std::vector<SignTap> taps = sign_taps(kSignPhases[p]);
    Phase& phase = phases_[p];
    phase.bias = weights[p].in_bias;
    phase.out = weights[p].out;
    phase.out_bias = weights[p].out_bias;
    for (std::size_t t = 0; t < taps.size();) {
      Row row{taps[t].y, taps[t].z, {}};
      for (; t < taps.size() && taps[t].y == row.y && taps[t].z == row.z; ++t)
        for (unsigned bits = 0; bits < 128; ++bits)
          for (std::size_t u = 0; u < kSignUnits; ++u) {
            const int weight = weights[p].in[t * kSignUnits + u];
            auto& sum = row.sums[bits][u];
            sum = static_cast<std::int16_t>(sum + (bits >> (taps[t].x + 3) & 1 ? weight : -weight));
          }
      phase.rows.push_back(row);
    }
  }
}

namespace {
SignModel read_model(const std::int16_t* at) {
  std::array<SignWeights, 7> weights;
  for (std::size_t p = 0; p < 7; ++p) {
    SignWeights& w = weights[p];
    w.in.resize(sign_taps(kSignPhases[p]).size() * kSignUnits);
    for (std::int8_t& v : w.in) v = static_cast<std::int8_t>(*at++);
    for (std::int16_t& v : w.in_bias) v = *at++;
    for (std::int16_t& v : w.out) v = *at++;
    for (std::int16_t& v : w.out_bias) v = *at++;
  }
  return SignModel(weights);
}
}  // namespace

const SignModel& SignModel::instance(std::size_t which) {
  static const std::array<SignModel, kSignModels> models{read_model(kSignWeightsScan), read_model(kSignWeightsSmooth)};
  return models[which];
}

}  // namespace dubsar
