#include "core/exa/signs/sign_model.h"

#include <algorithm>

#include "core/base/result.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/exa/signs/sign_model.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kRowsAtOnce = 4;  ///< all phases have a multiple of it besides the row of the point itself
constexpr unsigned kBefore = 2;         ///< of a window x - 3 .. x + 3: the bit of x - 2

/// Sums of the units times their weights. Integers: the same on every target.
#if HWY_TARGET == HWY_SCALAR
std::int32_t scaled_sum(const SignModel::Place& place, const std::int16_t* sum, const std::int16_t* add) {
  const std::int16_t* out = place.phase->out.front().data();
  std::int32_t total = 0;
  for (std::size_t u = 0; u < place.units; ++u)
    total += std::int32_t{std::clamp<std::int16_t>(static_cast<std::int16_t>(sum[u] + add[u]), 0, 1023)} * out[u];
  return total;
}

void weigh(const SignModel::Place& place, const unsigned char* row, std::span<const std::uint8_t> xs,
           std::int32_t* totals) {
  const SignModel::Phase& phase = *place.phase;
  const std::int16_t* sums = phase.sums.front().data();
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const unsigned char* here = row + ((xs[i] + 5) >> 3);
    const int shift = (xs[i] + 5) & 7;
    const auto window = [&](std::size_t r) {
      std::uint16_t bits;
      std::memcpy(&bits, here + place.steps[r], sizeof bits);
      return bits >> shift & 127u;
    };
    std::array<std::int16_t, kSignUnits> sum{};
    std::copy_n(phase.bias.front().data(), place.units, sum.data());
    const std::size_t own = phase.rows.size() - 1;
    for (std::size_t r = 0; r < own; ++r) {
      const std::int16_t* add = sums + phase.rows[r].at[window(r)] * place.units;
      for (std::size_t u = 0; u < place.units; ++u) sum[u] = static_cast<std::int16_t>(sum[u] + add[u]);
    }
    const auto& at = phase.rows[own].at;
    totals[2 * i] = scaled_sum(place, sum.data(), sums + at[window(own)] * place.units);
    const bool open = i > 0 && xs[i] == xs[i - 1] + 2;
    totals[2 * i + 1] =
        open ? scaled_sum(place, sum.data(), sums + at[window(own) | kBefore] * place.units) : totals[2 * i];
  }
}
#else
template <std::size_t kUnits>
HWY_INLINE void weigh_units(const SignModel::Place& place, const unsigned char* row, std::span<const std::uint8_t> xs,
                            std::int32_t* totals) {
  const hn::CappedTag<std::int16_t, std::min<std::size_t>(kUnits, 32)> d;
  const hn::RepartitionToWide<decltype(d)> d32;
  constexpr std::size_t kWidth = hn::MaxLanes(decltype(d)()), kVectors = kUnits / kWidth;
  using V = hn::Vec<decltype(d)>;
  const SignModel::Phase& phase = *place.phase;
  const std::int16_t *sums = phase.sums.front().data(), *out = phase.out.front().data();
  const SignModel::Row* rows = phase.rows.data();
  const std::size_t own = phase.rows.size() - 1;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const unsigned char* here = row + ((xs[i] + 5) >> 3);
    const int shift = (xs[i] + 5) & 7;
    const auto weights = [&](std::size_t r, unsigned set) HWY_ATTR {
      std::uint16_t bits;
      std::memcpy(&bits, here + place.steps[r], sizeof bits);
      return sums + rows[r].at[(bits >> shift & 127u) | set] * kUnits;
    };
    V sum[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) sum[v] = hn::Load(d, phase.bias.front().data() + v * kWidth);
    for (std::size_t r = 0; r < own; r += kRowsAtOnce)
#pragma GCC unroll 4
      for (std::size_t k = 0; k < kRowsAtOnce; ++k) {
        const std::int16_t* add = weights(r + k, 0);
        for (std::size_t v = 0; v < kVectors; ++v) sum[v] = hn::Add(sum[v], hn::Load(d, add + v * kWidth));
      }
    const auto total = [&](const std::int16_t* add) HWY_ATTR {
      auto even = hn::Zero(d32), odd = hn::Zero(d32);
      for (std::size_t v = 0; v < kVectors; ++v) {
        const V all = hn::Add(sum[v], hn::Load(d, add + v * kWidth));
        const V unit = hn::Min(hn::Max(all, hn::Zero(d)), hn::Set(d, std::int16_t{1023}));
        even = hn::ReorderWidenMulAccumulate(d32, unit, hn::Load(d, out + v * kWidth), even, odd);
      }
      return hn::GetLane(hn::SumOfLanes(d32, hn::Add(even, odd)));
    };
    totals[2 * i] = total(weights(own, 0));
    totals[2 * i + 1] = i > 0 && xs[i] == xs[i - 1] + 2 ? total(weights(own, kBefore)) : totals[2 * i];
  }
}
void weigh(const SignModel::Place& place, const unsigned char* row, std::span<const std::uint8_t> xs,
           std::int32_t* totals) {
  place.units == 16 ? weigh_units<16>(place, row, xs, totals) : weigh_units<64>(place, row, xs, totals);
}
#endif

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
#include "core/exa/signs/sign_weights.inc"
#include "core/exa/signs/sign_weights_wide.inc"
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

SignModel::SignModel(const std::array<SignWeights, 7>& weights, std::size_t units) : units_(units) {
  DUBSAR_CHECK(units == 16 || units == 64);
  for (std::size_t p = 0; p < 7; ++p) {
    const std::vector<SignTap> taps = sign_taps(kSignPhases[p]);
    Phase& phase = phases_[p];
    std::copy_n(weights[p].in_bias.data(), units, phase.bias.front().data());
    std::copy_n(weights[p].out.data(), units, phase.out.front().data());
    phase.out_bias = weights[p].out_bias;
    std::vector<std::int16_t> sums;
    for (std::size_t t = 0; t < taps.size();) {
      Row row{taps[t].y, taps[t].z, {}};
      const std::size_t first = t, start = sums.size() / units;
      while (t < taps.size() && taps[t].y == row.y && taps[t].z == row.z) ++t;
      for (std::size_t set = 0; set < std::size_t{1} << (t - first); ++set)
        for (std::size_t u = 0; u < units; ++u) {
          int sum = 0;
          for (std::size_t k = first; k < t; ++k)
            sum += (set >> (k - first) & 1 ? 1 : -1) * weights[p].in[k * kSignUnits + u];
          sums.push_back(static_cast<std::int16_t>(sum));
        }
      for (unsigned bits = 0; bits < 128; ++bits) {
        std::size_t set = 0;
        for (std::size_t k = first; k < t; ++k) set |= std::size_t{bits >> (taps[k].x + 3) & 1} << (k - first);
        row.at[bits] = static_cast<std::uint16_t>(start + set);
      }
      phase.rows.push_back(row);
    }
    phase.sums.resize((sums.size() + 31) / 32);
    std::copy(sums.begin(), sums.end(), phase.sums.front().data());
    const auto own =
        std::find_if(phase.rows.begin(), phase.rows.end(), [](const Row& r) { return r.y == 0 && r.z == 0; });
    if (own != phase.rows.end()) std::rotate(own, own + 1, phase.rows.end());
    DUBSAR_CHECK(phase.rows.size() % 4 == 1);  // kRowsAtOnce
  }
}

SignModel::Place SignModel::place(const SignLattice& lattice, std::size_t phase_index, std::size_t level_class) const {
  Place place;
  place.lattice = &lattice;
  place.phase = &phases_[phase_index];
  place.units = units_;
  place.out_bias = place.phase->out_bias[level_class];
  if (!hwy::GetChosenTarget().IsInitialized()) hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  place.weigh = &HWY_DYNAMIC_DISPATCH(weigh);  // looked up once a phase, not once a point
  for (std::size_t r = 0; r < place.phase->rows.size(); ++r)
    place.steps[r] = lattice.step(place.phase->rows[r].y, place.phase->rows[r].z);
  return place;
}

namespace {
std::int16_t logit_of(const SignModel::Place& place, std::int32_t total) {
  return static_cast<std::int16_t>(std::clamp((total >> 3) + place.out_bias, -2047, 2047));
}
}  // namespace

int SignModel::logit(const Place& place, int x, int y, int z) noexcept {
  const auto at = static_cast<std::uint8_t>(x);
  std::array<std::int32_t, 2> totals;
  place.weigh(place, place.lattice->row(y, z), {&at, 1}, totals.data());
  return logit_of(place, totals[0]);
}

void SignModel::row_logits(const Place& place, int y, int z, std::span<const std::uint8_t> xs,
                           SignLogits* out) noexcept {
  std::array<std::int32_t, 260> totals;
  place.weigh(place, place.lattice->row(y, z), xs, totals.data());
  for (std::size_t i = 0; i < xs.size(); ++i)
    out[i] = {logit_of(place, totals[2 * i]), logit_of(place, totals[2 * i + 1])};
}

namespace {
/// `units`: those that are stored.
std::array<SignWeights, 7> read_weights(const std::int16_t* at, std::size_t units) {
  std::array<SignWeights, 7> weights;
  for (std::size_t p = 0; p < 7; ++p) {
    SignWeights& w = weights[p];
    const std::size_t taps = sign_taps(kSignPhases[p]).size();
    w.in.resize(taps * kSignUnits);
    for (std::size_t t = 0; t < taps; ++t)
      for (std::size_t u = 0; u < units; ++u) w.in[t * kSignUnits + u] = static_cast<std::int8_t>(*at++);
    for (std::size_t u = 0; u < units; ++u) w.in_bias[u] = *at++;
    for (std::size_t u = 0; u < units; ++u) w.out[u] = *at++;
    for (std::int16_t& v : w.out_bias) v = *at++;
  }
  return weights;
}
}  // namespace

std::array<SignWeights, 7> SignModel::stored_weights(std::size_t model) {
  return model == 0   ? read_weights(kSignWeightsScan, 16)
         : model == 1 ? read_weights(kSignWeightsSmooth, 16)
                      : read_weights(kSignWeightsWide, 64);
}

const SignModel& SignModel::instance(std::size_t model) {
  static const std::array<SignModel, kSignModels> models{
      SignModel(stored_weights(0), 16), SignModel(stored_weights(1), 16), SignModel(stored_weights(2), 64)};
  return models[model];
}

}  // namespace dubsar
#endif
