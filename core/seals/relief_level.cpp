#include "core/seals/relief_level.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/parallel.h"
#include "core/seals/ground_spline.h"

namespace dubsar {
namespace {

constexpr double kLimbMm = 0.6;         // half the breadth of an arm on seals of 15 to 30 mm
constexpr double kParaboloidMm = 15.0;  // a body of 3.5 mm sinks into it by a tenth of a millimetre
constexpr double kParaboloidTop = 1.5;  // mm that it is followed down
constexpr double kNoiseMm = 0.25;       // deviation, before the opening, which goes by single low places
constexpr double kBrokenShare = 0.4;    // of what figures stand out: what lies lower than that broke away
constexpr double kLeastStandMm = 0.1, kMostStandMm = 0.8;  // of figures: seals are cut .3 to 1.5 mm deep

std::vector<float> gauss_kernel(double deviation) {
  const int reach = std::max(1, static_cast<int>(std::ceil(2.5 * deviation)));
  std::vector<float> out(static_cast<std::size_t>(reach) + 1);
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = static_cast<float>(std::exp(-0.5 * std::pow(static_cast<double>(k) / deviation, 2)));
  return out;
}

/// One direction of a separable blur; `stride` between neighbours of a line of `count`.
void blur_lines(const std::vector<float>& in, std::vector<float>& out, int lines, std::size_t line_stride, int count,
                std::size_t stride, const std::vector<float>& kernel) {
  const int reach = static_cast<int>(kernel.size()) - 1;
  parallel_for(lines, 16, [&](std::int64_t line) {
    const std::size_t begin = static_cast<std::size_t>(line) * line_stride;
    for (int i = 0; i < count; ++i) {
      float sum = 0.0f;
      for (int k = std::max(-reach, -i); k <= std::min(reach, count - 1 - i); ++k)
        sum += kernel[static_cast<std::size_t>(std::abs(k))] * in[begin + static_cast<std::size_t>(i + k) * stride];
      out[begin + static_cast<std::size_t>(i) * stride] = sum;
    }
  });
}

std::vector<float> blurred(const std::vector<float>& in, int width, int height, const std::vector<float>& kernel) {
  std::vector<float> half(in.size()), out(in.size());
  blur_lines(in, half, height, static_cast<std::size_t>(width), width, 1, kernel);
  blur_lines(half, out, width, 1, height, static_cast<std::size_t>(width), kernel);
  return out;
}

/// Erosion (sign -1) or dilation (1) with the paraboloid, one direction of the two.
void parabola_lines(const std::vector<float>& in, std::vector<float>& out, int lines, std::size_t line_stride,
                    int count, std::size_t stride, double step_mm, float sign) {
  const int reach = static_cast<int>(std::ceil(std::sqrt(2.0 * kParaboloidMm * kParaboloidTop) / step_mm));
  std::vector<float> sag(static_cast<std::size_t>(reach) + 1);
  for (std::size_t k = 0; k < sag.size(); ++k)
    sag[k] = static_cast<float>(std::pow(static_cast<double>(k) * step_mm, 2) / (2.0 * kParaboloidMm));
  parallel_for(lines, 8, [&](std::int64_t line) {
    const std::size_t begin = static_cast<std::size_t>(line) * line_stride;
    for (int i = 0; i < count; ++i) {
      float best = -1e30f;
      for (int k = std::max(-reach, -i); k <= std::min(reach, count - 1 - i); ++k)
        best = std::max(best, sign * in[begin + static_cast<std::size_t>(i + k) * stride] -
                                  sag[static_cast<std::size_t>(std::abs(k))]);
      out[begin + static_cast<std::size_t>(i) * stride] = sign * best;
    }
  });
}

/// What a paraboloid reaches from below.
std::vector<float> opened(std::vector<float> map, int width, int height, double step_mm) {
  std::vector<float> half(map.size());
  for (const float sign : {-1.0f, 1.0f}) {
    parabola_lines(map, half, height, static_cast<std::size_t>(width), width, 1, step_mm, sign);
    parabola_lines(half, map, width, 1, height, static_cast<std::size_t>(width), step_mm, sign);
  }
  return map;
}

/// The value that a share of the weighted values lies below.
float value_at(const std::vector<float>& values, const std::vector<float>& weights, double share) {
  std::vector<float> sorted;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (weights[k] > 0.0f) sorted.push_back(values[k]);
  if (sorted.empty()) return 0.0f;
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace

std::vector<float> weighted_blur(const std::vector<float>& values, const std::vector<float>& weights, int width,
                                 int height, double deviation, std::vector<float>* mean_weight) {
  const std::vector<float> kernel = gauss_kernel(deviation);
  std::vector<float> products(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) products[k] = weights[k] > 0.0f ? values[k] * weights[k] : 0.0f;
  std::vector<float> sums = blurred(products, width, height, kernel), all = blurred(weights, width, height, kernel);
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = all[k] > 1e-6f ? sums[k] / all[k] : 0.0f;
  if (mean_weight) {
    float line = kernel[0];
    for (std::size_t k = 1; k < kernel.size(); ++k) line += 2.0f * kernel[k];
    for (float& w : all) w /= line * line;
    *mean_weight = std::move(all);
  }
  return sums;
}

SealImpression level_impression(const HeightMap& relief) {
  SealImpression out{relief.width, relief.height, relief.step_mm, {}, {}, {}, {}};
  const auto blur = [&](const std::vector<float>& values, const std::vector<float>& weights, double mm) {
    return weighted_blur(values, weights, relief.width, relief.height, mm / relief.step_mm);
  };
  std::vector<float> height = relief.mm, measured(height.size(), 1.0f);
  for (std::size_t k = 0; k < height.size(); ++k)
    if (std::isnan(height[k])) height[k] = measured[k] = 0.0f;
  const std::vector<float> smooth = blur(height, measured, kNoiseMm);
  const std::vector<float> ground = opened(smooth, relief.width, relief.height, relief.step_mm);
  out.raised.resize(height.size());
  for (std::size_t k = 0; k < height.size(); ++k) out.raised[k] = measured[k] * std::max(0.0f, smooth[k] - ground[k]);
  const float stand = value_at(out.raised, measured, 0.95);
  const std::vector<float> level = ground_under(height, measured, {relief.width, relief.height, relief.step_mm},
                                                std::clamp(static_cast<double>(stand), kLeastStandMm, kMostStandMm));
  std::vector<float> broken(height.size());
  for (std::size_t k = 0; k < height.size(); ++k) {
    broken[k] = smooth[k] < level[k] - static_cast<float>(kBrokenShare) * stand ? 1.0f : 0.0f;
    out.raised[k] = std::min(out.raised[k], std::max(0.0f, smooth[k] - level[k]));
  }
  const std::vector<float> near = blur(broken, std::vector<float>(height.size(), 1.0f), kLimbMm);
  out.shown.resize(height.size());
  for (std::size_t k = 0; k < height.size(); ++k)
    out.shown[k] = measured[k] * std::clamp(1.0f - 2.0f * (near[k] - 0.1f), 0.0f, 1.0f);
  out.mm.resize(height.size());
  std::vector<float> square(height.size());
  for (std::size_t k = 0; k < height.size(); ++k) {
    out.mm[k] = out.shown[k] > 0.0f ? height[k] - level[k] : 0.0f;
    square[k] = out.raised[k] * out.raised[k];
  }
  out.figure = blur(square, out.shown, 1.5 * kLimbMm);
  return out;
}

}  // namespace dubsar
