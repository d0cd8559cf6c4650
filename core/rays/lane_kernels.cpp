#include "core/rays/lane_kernels.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/rays/lane_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, static_cast<std::size_t>(kLanes)>;
using Vector = hn::Vec<Tag>;
constexpr std::int64_t kVector = static_cast<std::int64_t>(hn::MaxLanes(Tag()));
constexpr std::int64_t kVectors = kLanes / kVector;
constexpr double kFixedOne = 4294967296.0;  // places as 32.32 fixed point
alignas(64) constexpr float kNothing[kLanes] = {};

HWY_INLINE float fraction_of(std::int64_t place) {
  return static_cast<float>(static_cast<std::int32_t>((place >> 8) & 0xFFFFFF)) * 0x1p-24F;
}

void ProjectBand(const CrossedBand& band, std::int64_t bins, float* HWY_RESTRICT row) {
  const Tag d;
  const auto crosses = [&](double place) { return place > -1.0 && place < static_cast<double>(band.minor); };
  for (std::int64_t bin = 0; bin < bins; ++bin) {
    const double start = band.first + band.per_bin * static_cast<double>(bin);
    const auto place = [&](std::int64_t m) { return start + band.per_major * static_cast<double>(m); };
    std::int64_t from = band.begin, to = band.end;
    if (std::abs(band.per_major) > 1e-9) {
      const double a = (-1.0 - start) / band.per_major, b = (static_cast<double>(band.minor) - start) / band.per_major;
      const auto bound = [&](double m) {
        return std::clamp(m, static_cast<double>(band.begin) - 1.0, static_cast<double>(band.end) + 1.0);
      };
      from = std::max(from, static_cast<std::int64_t>(std::floor(bound(std::min(a, b)))));
      to = std::min(to, static_cast<std::int64_t>(std::ceil(bound(std::max(a, b)))) + 1);
    }
    while (from < to && !crosses(place(from))) ++from;
    while (from < to && !crosses(place(to - 1))) --to;
    if (from >= to) continue;
    Vector sum[kVectors];
    for (std::int64_t v = 0; v < kVectors; ++v) sum[v] = hn::Zero(d);
    auto fixed = static_cast<std::int64_t>(std::floor(place(from) * kFixedOne));
    const auto step = static_cast<std::int64_t>(std::floor(band.per_major * kFixedOne));
    const float* line = band.image + from * band.major_stride;
    for (std::int64_t m = from; m < to; ++m, fixed += step, line += band.major_stride) {
      // Rounding of the step may lead a hair beyond the last group.
      const std::int64_t cell = std::clamp<std::int64_t>(fixed >> 32, -1, band.minor - 1);
      const Vector right = hn::Set(d, fraction_of(fixed));
      const float* at = line + cell * band.minor_stride;
      const float* const before = cell >= 0 ? at : kNothing;
      const float* const behind = cell + 1 < band.minor ? at + band.minor_stride : kNothing;
      for (std::int64_t v = 0; v < kVectors; ++v) {
        const Vector low = hn::LoadU(d, before + v * kVector);
        const Vector high = hn::LoadU(d, behind + v * kVector);
        sum[v] = hn::Add(sum[v], hn::MulAdd(right, hn::Sub(high, low), low));
      }
    }
    const Vector weight = hn::Set(d, band.weight);
    float* to_row = row + bin * kLanes;
    for (std::int64_t v = 0; v < kVectors; ++v)
      hn::StoreU(hn::MulAdd(weight, sum[v], hn::LoadU(d, to_row + v * kVector)), d, to_row + v * kVector);
  }
}

void BackprojectRow(const RowRays& rays, std::int64_t begin, std::int64_t end, float* HWY_RESTRICT row) {
  const Tag d;
  constexpr std::int64_t kMost = 64;
  std::int64_t fixed[kMost], step[kMost];
  for (std::int64_t first = 0; first < rays.count; first += kMost) {
    const std::int64_t count = std::min(kMost, rays.count - first);
    for (std::int64_t k = 0; k < count; ++k) {
      const double place = rays.base[first + k] + rays.step[first + k] * static_cast<double>(begin);
      fixed[k] = static_cast<std::int64_t>(std::floor(place * kFixedOne));
      step[k] = static_cast<std::int64_t>(std::floor(rays.step[first + k] * kFixedOne));
    }
    const float* const* projections = rays.rows + first;
    for (std::int64_t x = begin; x < end; ++x) {
      Vector sum[kVectors];
      float* to = row + x * kLanes;
      for (std::int64_t v = 0; v < kVectors; ++v) sum[v] = hn::LoadU(d, to + v * kVector);
      for (std::int64_t k = 0; k < count; ++k) {
        const Vector right = hn::Set(d, fraction_of(fixed[k]));
        const float* at = projections[k] + (fixed[k] >> 32) * kLanes;
        fixed[k] += step[k];
        for (std::int64_t v = 0; v < kVectors; ++v) {
          const Vector low = hn::LoadU(d, at + v * kVector);
          const Vector high = hn::LoadU(d, at + kLanes + v * kVector);
          sum[v] = hn::Add(sum[v], hn::MulAdd(right, hn::Sub(high, low), low));
        }
      }
      for (std::int64_t v = 0; v < kVectors; ++v) hn::StoreU(sum[v], d, to + v * kVector);
    }
  }
}

void AddInterpolated(const float* HWY_RESTRICT in, std::int64_t groups, double start, std::int64_t count,
                     float* HWY_RESTRICT out) {
  const Tag d;
  const auto cell = static_cast<std::int64_t>(std::floor(start));
  const CubicWeights weights(start - static_cast<double>(cell));
  // Groups of `out` all of whose four neighbours are there.
  const std::int64_t begin = std::clamp<std::int64_t>(1 - cell, 0, count);
  const std::int64_t end = std::clamp<std::int64_t>(groups - 2 - cell, begin, count);
  const auto at_end = [&](std::int64_t i) {
    for (std::int64_t tap = 0; tap < 4; ++tap) {
      const std::int64_t from = cell + i + tap - 1;
      if (from < 0 || from >= groups) continue;
      const Vector weight = hn::Set(d, weights.of[static_cast<std::size_t>(tap)]);
      for (std::int64_t v = 0; v < kVectors; ++v) {
        float* const to = out + i * kLanes + v * kVector;
        hn::StoreU(hn::MulAdd(weight, hn::LoadU(d, in + from * kLanes + v * kVector), hn::LoadU(d, to)), d, to);
      }
    }
  };
  for (std::int64_t i = 0; i < begin; ++i) at_end(i);
  const Vector w0 = hn::Set(d, weights.of[0]), w1 = hn::Set(d, weights.of[1]), w2 = hn::Set(d, weights.of[2]),
               w3 = hn::Set(d, weights.of[3]);
  for (std::int64_t i = begin; i < end; ++i)
    for (std::int64_t v = 0; v < kVectors; ++v) {
      const float* const from = in + (cell + i - 1) * kLanes + v * kVector;
      float* const to = out + i * kLanes + v * kVector;
      const Vector inner = hn::MulAdd(w1, hn::LoadU(d, from + kLanes), hn::LoadU(d, to));
      const Vector outer = hn::MulAdd(w3, hn::LoadU(d, from + 3 * kLanes), hn::Mul(w0, hn::LoadU(d, from)));
      hn::StoreU(hn::Add(hn::MulAdd(w2, hn::LoadU(d, from + 2 * kLanes), inner), outer), d, to);
    }
  for (std::int64_t i = end; i < count; ++i) at_end(i);
}

void AddSampled(const LaneRow& in, double first, double step, float weight, std::int64_t bins,
                float* HWY_RESTRICT out) {
  const Tag d;
  // Bins whose four neighbours are there, or some of them.
  const double a = (-2.0 - first) / step, b = (static_cast<double>(in.count) + 1.0 - first) / step;
  const auto bound = [&](double bin) {
    return static_cast<std::int64_t>(std::clamp(bin, 0.0, static_cast<double>(bins)));
  };
  const std::int64_t begin = bound(std::floor(std::min(a, b))), end = bound(std::ceil(std::max(a, b)) + 1.0);
  const Vector sixth = hn::Set(d, weight / 6.0F), half = hn::Set(d, weight / 2.0F);
  const Vector one = hn::Set(d, 1.0F), two = hn::Set(d, 2.0F);
  for (std::int64_t bin = begin; bin < end; ++bin) {
    const double place = first + step * static_cast<double>(bin), whole = std::floor(place);
    const auto cell = static_cast<std::int64_t>(whole);
    if (cell < -2 || cell > in.count) continue;
    const Vector t = hn::Set(d, static_cast<float>(place - whole));
    const Vector before = hn::Add(t, one), after = hn::Sub(one, t), next = hn::Sub(two, t);
    const Vector middle = hn::Mul(t, after), outer = hn::Mul(before, next);
    const Vector weights[4] = {hn::Neg(hn::Mul(sixth, hn::Mul(middle, next))), hn::Mul(half, hn::Mul(outer, after)),
                               hn::Mul(half, hn::Mul(outer, t)), hn::Neg(hn::Mul(sixth, hn::Mul(middle, before)))};
    Vector sum[kVectors];
    for (std::int64_t v = 0; v < kVectors; ++v) sum[v] = hn::LoadU(d, out + bin * kLanes + v * kVector);
    for (std::int64_t tap = 0; tap < 4; ++tap) {
      const std::int64_t from = cell + tap - 1;
      if (from < 0 || from >= in.count) continue;
      for (std::int64_t v = 0; v < kVectors; ++v)
        sum[v] = hn::MulAdd(weights[tap], hn::LoadU(d, in.groups + from * kLanes + v * kVector), sum[v]);
    }
    for (std::int64_t v = 0; v < kVectors; ++v) hn::StoreU(sum[v], d, out + bin * kLanes + v * kVector);
  }
}

void RampRow(const float* HWY_RESTRICT in, std::int64_t bins, const float* HWY_RESTRICT odd, std::int64_t reach,
             float* HWY_RESTRICT out) {
  const Tag d;
  constexpr std::int64_t kOutputs = 4;  // of one parity at a time: each input is loaded once for all
  const Vector quarter = hn::Set(d, 0.25F);
  for (std::int64_t parity = 0; parity < 2; ++parity)
    for (std::int64_t first = parity; first < bins; first += 2 * kOutputs) {
      Vector sum[kOutputs][kVectors];
      for (auto& output : sum)
        for (std::int64_t v = 0; v < kVectors; ++v) output[v] = hn::Zero(d);
      const std::int64_t end = std::min(bins, first + 2 * (kOutputs - 1) + reach + 1);
      for (std::int64_t from = std::max(1 - parity, first - reach); from < end; from += 2) {
        const float* at = in + from * kLanes;
        for (std::int64_t k = 0; k < kOutputs; ++k) {
          const std::int64_t apart = std::abs(first + 2 * k - from);
          const Vector weight = hn::Set(d, odd[apart / 2]);
          for (std::int64_t v = 0; v < kVectors; ++v)
            sum[k][v] = hn::MulAdd(weight, hn::LoadU(d, at + v * kVector), sum[k][v]);
        }
      }
      for (std::int64_t k = 0; k < kOutputs && first + 2 * k < bins; ++k)
        for (std::int64_t v = 0; v < kVectors; ++v) {
          const std::int64_t at = (first + 2 * k) * kLanes + v * kVector;
          hn::StoreU(hn::MulAdd(quarter, hn::LoadU(d, in + at), sum[k][v]), d, out + at);
        }
    }
}

void FarRow(const float* HWY_RESTRICT in, std::int64_t cells, const float* HWY_RESTRICT far, std::int64_t first,
            std::int64_t count, float* HWY_RESTRICT out) {
  const Tag d;
  for (std::int64_t k = 0; k < count; k += kFarOutputs) {
    Vector sum[kFarOutputs][kVectors];
    for (auto& output : sum)
      for (std::int64_t v = 0; v < kVectors; ++v) output[v] = hn::Zero(d);
    for (std::int64_t cell = 0; cell < cells; ++cell)
      for (std::int64_t j = 0; j < kFarOutputs; ++j) {
        const Vector weight = hn::Set(d, far[std::abs(first + k + j - cell)]);
        for (std::int64_t v = 0; v < kVectors; ++v)
          sum[j][v] = hn::MulAdd(weight, hn::LoadU(d, in + cell * kLanes + v * kVector), sum[j][v]);
      }
    for (std::int64_t j = 0; j < kFarOutputs; ++j)
      for (std::int64_t v = 0; v < kVectors; ++v) hn::StoreU(sum[j][v], d, out + (k + j) * kLanes + v * kVector);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::kernels {

HWY_EXPORT(ProjectBand);
HWY_EXPORT(BackprojectRow);
HWY_EXPORT(AddInterpolated);
HWY_EXPORT(AddSampled);
HWY_EXPORT(RampRow);
HWY_EXPORT(FarRow);

void project_band(const CrossedBand& band, std::int64_t bins, float* row) {
  HWY_DYNAMIC_DISPATCH(ProjectBand)(band, bins, row);
}
void backproject_row(const RowRays& rays, std::int64_t begin, std::int64_t end, float* row) {
  HWY_DYNAMIC_DISPATCH(BackprojectRow)(rays, begin, end, row);
}
void add_interpolated(const float* in, std::int64_t groups, double start, std::int64_t count, float* out) {
  HWY_DYNAMIC_DISPATCH(AddInterpolated)(in, groups, start, count, out);
}
void add_sampled(const LaneRow& in, double first, double step, float weight, std::int64_t bins, float* out) {
  HWY_DYNAMIC_DISPATCH(AddSampled)(in, first, step, weight, bins, out);
}
void ramp_row(const float* in, std::int64_t bins, const float* odd, std::int64_t reach, float* out) {
  HWY_DYNAMIC_DISPATCH(RampRow)(in, bins, odd, reach, out);
}
void far_row(const float* in, std::int64_t cells, const float* far, std::int64_t first, std::int64_t count,
             float* out) {
  HWY_DYNAMIC_DISPATCH(FarRow)(in, cells, far, first, count, out);
}

}  // namespace dubsar::kernels
#endif
