#include "core/exa/sign_model.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/exa/sign_model.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// Sum of the units times their weights. Integers: the same on every target.
#if HWY_TARGET == HWY_SCALAR
std::int32_t weigh(const SignModel::Place& place, const unsigned char* here, int shift) {
  const SignModel::Phase& phase = *place.phase;
  SignModel::Sums sum = phase.bias;
  for (std::size_t r = 0; r < phase.rows.size(); ++r) {
    std::uint16_t bits;
    std::memcpy(&bits, here + place.steps[r], sizeof bits);
    const SignModel::Sums& add = phase.rows[r].sums[bits >> shift & 127];
    for (std::size_t u = 0; u < sum.size(); ++u) sum[u] = static_cast<std::int16_t>(sum[u] + add[u]);
  }
  std::int32_t total = 0;
  for (std::size_t u = 0; u < sum.size(); ++u)
    total += std::int32_t{std::clamp<std::int16_t>(sum[u], 0, 1023)} * phase.out[u];
  return total;
}
#else
std::int32_t weigh(const SignModel::Place& place, const unsigned char* here, int shift) {
  const hn::CappedTag<std::int16_t, kSignUnits> d;
  const hn::RepartitionToWide<decltype(d)> d32;
  const SignModel::Phase& phase = *place.phase;
  const std::size_t width = hn::Lanes(d), rows = phase.rows.size();
  auto even = hn::Zero(d32), odd = hn::Zero(d32);
  for (std::size_t u = 0; u < kSignUnits; u += width) {
    auto sum = hn::Load(d, phase.bias.data() + u);
    for (std::size_t r = 0; r < rows; ++r) {
      std::uint16_t bits;
      std::memcpy(&bits, here + place.steps[r], sizeof bits);
      sum = hn::Add(sum, hn::Load(d, phase.rows[r].sums[bits >> shift & 127].data() + u));
    }
    sum = hn::Min(hn::Max(sum, hn::Zero(d)), hn::Set(d, std::int16_t{1023}));
    even = hn::ReorderWidenMulAccumulate(d32, sum, hn::Load(d, phase.out.data() + u), even, odd);
  }
  return hn::GetLane(hn::SumOfLanes(d32, hn::Add(even, odd)));
}
#endif

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
#include "core/exa/sign_weights.inc"
HWY_EXPORT(weigh);
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
    static_cast<std::array<std::int16_t, kSignUnits>&>(phase.bias) = weights[p].in_bias;
    static_cast<std::array<std::int16_t, kSignUnits>&>(phase.out) = weights[p].out;
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
    const auto own =
        std::find_if(phase.rows.begin(), phase.rows.end(), [](const Row& r) { return r.y == 0 && r.z == 0; });
    if (own != phase.rows.end()) std::rotate(own, own + 1, phase.rows.end());
  }
}

SignModel::Place SignModel::place(const SignLattice& lattice, std::size_t phase_index, std::size_t level_class) const {
  Place place;
  place.lattice = &lattice;
  place.phase = &phases_[phase_index];
  place.out_bias = place.phase->out_bias[level_class];
  for (std::size_t r = 0; r < place.phase->rows.size(); ++r)
    place.steps[r] = lattice.step(place.phase->rows[r].y, place.phase->rows[r].z);
  return place;
}

int SignModel::logit(const Place& place, int x, int y, int z) noexcept {
  const unsigned char* here = place.lattice->row(y, z) + ((x + 5) >> 3);
  const std::int32_t total = HWY_DYNAMIC_DISPATCH(weigh)(place, here, (x + 5) & 7);
  return std::clamp((total >> 3) + place.out_bias, -2047, 2047);
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
#endif
