#include "core/filter/mixture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dubsar {
namespace {

constexpr int kSteps = 100;

/// Mean and standard deviation of bins [begin, end).
Mixture::Component moments(const Histogram& h, std::size_t begin, std::size_t end) {
  double mass = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double x = h.centre(static_cast<double>(i));
    mass += h.mass[i];
    sum += h.mass[i] * x;
  }
  const double mean = mass > 0.0 ? sum / mass : h.centre(static_cast<double>(begin));
  for (std::size_t i = begin; i < end; ++i) squares += h.mass[i] * std::pow(h.centre(static_cast<double>(i)) - mean, 2);
  return {mass, mean, std::max(mass > 0.0 ? std::sqrt(squares / mass) : 0.0, 0.5 * h.width)};
}

}  // namespace

double density(const Mixture::Component& c, double x) {
  const double t = (x - c.mean) / c.sigma;
  return c.weight / (c.sigma * std::sqrt(2.0 * std::numbers::pi)) * std::exp(-0.5 * t * t);
}

OtsuSplit otsu_split(const Histogram& h) {
  const Mixture::Component all = moments(h, 0, h.mass.size());
  OtsuSplit best;
  double mass = 0.0, sum = 0.0, best_between = -1.0;
  const double total = all.weight, total_sum = all.weight * all.mean;
  double first_at = 0.0;  // an empty valley has many best thresholds: the middle is taken
  for (std::size_t i = 0; i + 1 < h.mass.size(); ++i) {
    mass += h.mass[i];
    sum += h.mass[i] * h.centre(static_cast<double>(i));
    if (mass <= 0.0 || mass >= total) continue;
    const double low = sum / mass, high = (total_sum - sum) / (total - mass);
    const double between = mass / total * (1.0 - mass / total) * (high - low) * (high - low);
    const double at = h.low + static_cast<double>(i + 1) * h.width;
    if (between > best_between * (1.0 + 1e-12)) {
      best_between = between;
      first_at = at;
      best = {at, low, high, 1.0 - mass / total, between / (all.sigma * all.sigma)};
    } else if (between >= best_between * (1.0 - 1e-12)) {
      best.threshold = 0.5 * (first_at + at);
    }
  }
  return best;
}

Mixture fit_mixture(const Histogram& h, int count) {
  const std::size_t bins = h.mass.size();
  const OtsuSplit split = otsu_split(h);
  const auto cut =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::lround((split.threshold - h.low) / h.width)), 1, bins - 1);
  const Mixture::Component low = moments(h, 0, cut), high = moments(h, cut, bins);
  const double total = low.weight + high.weight;

  Mixture m;
  m.plateau = 0.05;
  for (int k = 0; k < count; ++k) {
    const double t = count > 1 ? static_cast<double>(k) / (count - 1) : 0.5;
    m.components.push_back(
        {0.95 / count, low.mean + t * (high.mean - low.mean), (1.0 - t) * low.sigma + t * high.sigma});
  }
  std::vector<double> weight(m.components.size()), sum(weight), squares(weight), at(weight);
  for (int step = 0; step < kSteps; ++step) {
    std::fill(weight.begin(), weight.end(), 0.0);
    sum = squares = weight;
    double plateau = 0.0;
    const double left = m.components.front().mean, right = m.components.back().mean;
    const double flat = m.plateau / std::max(right - left, h.width);
    for (std::size_t i = 0; i < bins; ++i) {
      if (h.mass[i] <= 0.0) continue;
      const double x = h.centre(static_cast<double>(i)), here = x > left && x < right ? flat : 0.0;
      double all = here;
      for (std::size_t k = 0; k < at.size(); ++k) all += at[k] = density(m.components[k], x);
      if (all < 1e-300) continue;  // far from everything
      plateau += h.mass[i] * here / all;
      for (std::size_t k = 0; k < at.size(); ++k) {
        const double share = h.mass[i] * at[k] / all, d = x - m.components[k].mean;
        weight[k] += share;
        sum[k] += share * d;
        squares[k] += share * d * d;
      }
    }
    for (std::size_t k = 0; k < weight.size(); ++k) {
      Mixture::Component& c = m.components[k];
      c.weight = weight[k] / total;
      if (weight[k] <= 1e-9 * total) continue;
      const double shift = sum[k] / weight[k];
      c.mean += shift;
      c.sigma = std::max(std::sqrt(std::max(squares[k] / weight[k] - shift * shift, 0.0)), 0.5 * h.width);
    }
    m.plateau = plateau / total;
    std::sort(m.components.begin(), m.components.end(), [](const auto& a, const auto& b) { return a.mean < b.mean; });
  }
  return m;
}

double separation(const Mixture::Component& a, const Mixture::Component& b) {
  return std::numbers::sqrt2 * std::abs(a.mean - b.mean) / std::sqrt(a.sigma * a.sigma + b.sigma * b.sigma);
}

double equal_posterior(const Mixture::Component& low, const Mixture::Component& high) {
  double left = low.mean, right = high.mean;
  if (density(low, left) <= density(high, left) || density(high, right) <= density(low, right))
    return 0.5 * (left + right);
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (left + right);
    (density(low, middle) > density(high, middle) ? left : right) = middle;
  }
  return 0.5 * (left + right);
}

}  // namespace dubsar
