#include "core/script/imprint/imprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/script/imprint/imprint_kernels.h"

namespace dubsar {

namespace kernels = imprint_kernels;

namespace {

// The groove behind a head: its depth and half width at T, of those of the head. By eye on shaded pictures of tablets;
// both are what separates the steep head from the shallow tail, not what is measured.
constexpr float kGrooveDepth = 0.55f, kGrooveWidth = 0.5f;
// Where the loss turns from squares to logarithms, of a head's width: three times the noise of clay at 17 dB.
constexpr float kImprintScale = 0.06f;

struct Belief {
  double log_mean, deviation;
};
// Over the width: h / W about .3, and T to the end of the head about .8 (docs/edition.md); wide, as hands differ.
constexpr Belief kBackBelief{-1.15, 0.35}, kFrontBelief{-0.22, 0.45}, kTailBelief{0.6, 0.6};
constexpr double kWidthDeviation = 0.35, kDepthDeviation = 0.45;
constexpr double kBeliefWeight = 4e-5;  // a deviation of one costs some hundredths of what a wedge explains

kernels::Planes planes_of(const Imprint& i) {
  kernels::Planes p{};
  p.x = static_cast<float>(i.p[Imprint::kX]), p.y = static_cast<float>(i.p[Imprint::kY]);
  p.c = static_cast<float>(std::cos(i.p[Imprint::kAngle])), p.s = static_cast<float>(std::sin(i.p[Imprint::kAngle]));
  p.depth = static_cast<float>(i.depth());
  p.head = static_cast<float>(i.depth() / i.back());
  p.tip = static_cast<float>(i.depth() / i.front());
  p.flank = static_cast<float>(2.0 * i.depth() * (1.0 + i.back() / i.front()) / i.width());
  p.groove = i.tailed ? kGrooveDepth * p.depth : -1.0f;
  p.groove_tip = i.tailed ? p.groove / static_cast<float>(std::exp(i.p[Imprint::kTail]) * i.width()) : 0.0f;
  p.groove_flank = i.tailed ? p.groove / (0.5f * kGrooveWidth * static_cast<float>(i.width())) : 0.0f;
  p.rounding = static_cast<float>(i.rounding);
  p.quarter = i.rounding > 0.0 ? static_cast<float>(0.25 / i.rounding) : 0.0f;
  return p;
}

kernels::Samples view_of(const DepthSamples& s) {
  return {s.x.data(), s.y.data(), s.depth.data(), s.weight.data(), s.others.data(), s.size()};
}

double square(double v) { return v * v; }

double belief_cost(const Imprint& i, const UsualImprint& usual) {
  double sum = square((i.p[Imprint::kBack] - kBackBelief.log_mean) / kBackBelief.deviation) +
               square((i.p[Imprint::kFront] - kFrontBelief.log_mean) / kFrontBelief.deviation) +
               square(i.p[Imprint::kWidth] / kWidthDeviation) +
               square((i.p[Imprint::kDepth] - std::log(usual.depth)) / kDepthDeviation);
  if (i.tailed) sum += square((i.p[Imprint::kTail] - kTailBelief.log_mean) / kTailBelief.deviation);
  return 0.5 * kBeliefWeight * sum;
}

/// Adds the gradient and the curvature of belief_cost().
void add_beliefs(const Imprint& i, const UsualImprint& usual, std::array<std::array<double, 8>, 8>& h,
                 std::array<double, 8>& g) {
  const auto add = [&](std::size_t k, double mean, double deviation) {
    h[k][k] += kBeliefWeight / square(deviation);
    g[k] -= kBeliefWeight * (i.p[k] - mean) / square(deviation);
  };
  add(Imprint::kBack, kBackBelief.log_mean, kBackBelief.deviation);
  add(Imprint::kFront, kFrontBelief.log_mean, kFrontBelief.deviation);
  add(Imprint::kWidth, 0.0, kWidthDeviation);
  add(Imprint::kDepth, std::log(usual.depth), kDepthDeviation);
  if (i.tailed) add(Imprint::kTail, kTailBelief.log_mean, kTailBelief.deviation);
}

constexpr float kImprintSquare = kImprintScale * kImprintScale, kImprintMost = 6.0f;

/// As r^2 where r is small, at most kImprintMost times the square of the scale (Geman and McClure).
float loss(float r, float deeper) {
  const float q = r * r * (1.0f / kImprintSquare);
  return (r > 0.0f ? deeper : 1.0f) * kImprintSquare * q / (1.0f + q * (1.0f / kImprintMost));
}

/// Sums value(i) over all samples, in lanes beside each other, so that they are one instruction.
template <class Value>
double sum_of(std::size_t count, const Value& value) {
  constexpr std::size_t kLanes = 8;
  std::array<float, kLanes> sums{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += value(i + lane);
  for (; i < count; ++i) sums[0] += value(i);
  double sum = 0.0;
  for (const float s : sums) sum += static_cast<double>(s);
  return sum;
}

/// What model and others explain at each sample.
void model_of(const Imprint& imprint, const DepthSamples& samples, std::vector<float>& out) {
  kernels::model(planes_of(imprint), view_of(samples), out.data());
}

/// Solves by Gauss elimination with pivots; false where there is no solution.
bool solve(std::array<std::array<double, 8>, 8> m, std::array<double, 8> v, std::array<double, 8>& out) {
  constexpr std::size_t n = 8;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < n; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    if (std::abs(m[pivot][c]) < 1e-14) return false;
    std::swap(m[c], m[pivot]);
    std::swap(v[c], v[pivot]);
    for (std::size_t r = c + 1; r < n; ++r) {
      const double part = m[r][c] / m[c][c];
      for (std::size_t k = c; k < n; ++k) m[r][k] -= part * m[c][k];
      v[r] -= part * v[c];
    }
  }
  for (std::size_t c = n; c-- > 0;) {
    double sum = v[c];
    for (std::size_t k = c + 1; k < n; ++k) sum -= m[c][k] * out[k];
    out[c] = sum / m[c][c];
  }
  return true;
}

}  // namespace

double angle_apart(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * std::numbers::pi)); }

double Imprint::width() const { return std::exp(p[kWidth]); }
double Imprint::depth() const { return std::exp(p[kDepth]); }
double Imprint::back() const { return std::exp(p[kBack] + p[kWidth]); }
double Imprint::front() const { return std::exp(p[kFront] + p[kWidth]); }
double Imprint::reach() const { return tailed ? std::max(front(), std::exp(p[kTail] + p[kWidth])) : front(); }

void imprint_depths(const Imprint& imprint, const DepthSamples& samples, std::vector<float>& out) {
  const std::vector<float> none(samples.size(), 0.0f);
  kernels::Samples view = view_of(samples);
  view.others = none.data();
  out.resize(samples.size());
  kernels::model(planes_of(imprint), view, out.data());
}

void explain_by_other(const Imprint& imprint, const ImprintView& view, DepthSamples& samples) {
  constexpr float kOtherSheet = 1.5f;
  const std::size_t count = samples.size();
  const auto on = [](const std::array<float, 4>& f, float x, float y, float z) {
    return f[0] + f[1] * x + f[2] * y + f[3] * z;
  };
  std::vector<float> along(count), across(count), depth(count);
  for (std::size_t i = 0; i < count; ++i) {
    along[i] = on(view.along, samples.x[i], samples.y[i], samples.level[i]);
    across[i] = on(view.across, samples.x[i], samples.y[i], samples.level[i]);
  }
  kernels::Planes planes = planes_of(imprint);
  planes.x = planes.y = planes.s = 0.0f, planes.c = 1.0f;  // the view is its own frame
  kernels::Samples own = view_of(samples);
  own.x = along.data(), own.y = across.data();
  kernels::model(planes, own, depth.data());
  for (std::size_t i = 0; i < count; ++i)
    if (depth[i] > samples.others[i] &&
        std::abs(on(view.above, samples.x[i], samples.y[i], samples.level[i])) < kOtherSheet)
      samples.others[i] = depth[i];
}

double empty_energy(const DepthSamples& samples, const FitOptions& options) {
  const auto deeper = static_cast<float>(options.deeper);
  return static_cast<double>(samples.area) * sum_of(samples.size(), [&](std::size_t i) {
           return samples.weight[i] * loss(samples.depth[i] - samples.others[i], deeper);
         });
}

double imprint_energy(const Imprint& imprint, const DepthSamples& samples, const UsualImprint& usual,
                      const FitOptions& options) {
  const kernels::Loss loss{1.0f / kImprintSquare, kImprintSquare, 1.0f / kImprintMost,
                           static_cast<float>(options.deeper)};
  const double sum = kernels::misfit(planes_of(imprint), view_of(samples), loss);
  return sum * static_cast<double>(samples.area) + belief_cost(imprint, usual);
}

double fit_imprint(Imprint& imprint, const DepthSamples& samples, const UsualImprint& usual,
                   const FitOptions& options) {
  constexpr std::array<double, Imprint::kCount> kSteps{0.01, 0.01, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02};
  constexpr double kLeastLog = -2.3, kMostLog = 1.3;
  const std::size_t count = samples.size();
  std::vector<float> here(count), weight(count), rest(count);
  std::array<std::vector<float>, Imprint::kCount> slope;
  for (auto& one : slope) one.resize(count);
  const std::size_t used = imprint.tailed ? Imprint::kCount : Imprint::kTail;
  double energy = imprint_energy(imprint, samples, usual, options), damping = 1e-3;
  for (int round = 0; round < options.rounds; ++round) {
    std::array<std::array<double, 8>, 8> h{};
    std::array<double, 8> g{};
    model_of(imprint, samples, here);
    const auto deeper = static_cast<float>(options.deeper);
    for (std::size_t i = 0; i < count; ++i) {
      const float r = samples.depth[i] - here[i], flat = 1.0f + r * r * (1.0f / (kImprintMost * kImprintSquare));
      weight[i] = samples.weight[i] * samples.area * (r > 0.0f ? deeper : 1.0f) / (flat * flat);
      rest[i] = weight[i] * r;
    }
    for (std::size_t k = 0; k < used; ++k) {
      Imprint one = imprint;
      one.p[k] += kSteps[k];
      model_of(one, samples, slope[k]);
      const auto per_step = static_cast<float>(1.0 / kSteps[k]);
      for (std::size_t i = 0; i < count; ++i) slope[k][i] = (slope[k][i] - here[i]) * per_step;
    }
    for (std::size_t a = 0; a < used; ++a) {
      g[a] = kernels::product(slope[a].data(), rest.data(), count);
      for (std::size_t b = a; b < used; ++b)
        h[a][b] = h[b][a] = kernels::product(weight.data(), slope[a].data(), slope[b].data(), count);
    }
    add_beliefs(imprint, usual, h, g);
    bool better = false;
    for (int tries = 0; tries < 4 && !better; ++tries) {
      auto damped = h;
      for (std::size_t k = 0; k < 8; ++k) damped[k][k] += damping * (h[k][k] + 1e-6) + (k >= used ? 1.0 : 0.0);
      std::array<double, 8> step{};
      if (!solve(damped, g, step)) break;
      Imprint next = imprint;
      for (std::size_t k = 0; k < used; ++k) {
        const double most = k < 2 ? 0.3 : k == 2 ? 0.5 : 0.4;
        next.p[k] += std::clamp(step[k], -most, most);
        if (k > Imprint::kAngle) next.p[k] = std::clamp(next.p[k], kLeastLog, kMostLog);
      }
      const double found = imprint_energy(next, samples, usual, options);
      if (found < energy) {
        const bool settled = energy - found < 1e-4 * energy;
        imprint = next;
        energy = found;
        damping = std::max(1e-6, damping * 0.3);
        better = true;
        if (settled) return energy;
      } else {
        damping *= 8.0;
      }
    }
    if (!better) break;
  }
  return energy;
}

std::vector<ImprintStart> imprint_starts(const DepthSamples& samples, const UsualImprint& usual, double x, double y,
                                         int directions, const FitOptions& options) {
  std::vector<ImprintStart> out;
  for (int d = 0; d < directions; ++d) {
    ImprintStart best;
    best.energy = 1e30;
    for (const double width : {0.75, 1.05})
      for (const double front : {0.6, 1.0})
        for (const double tail : {0.0, 1.4, 2.4}) {
          Imprint i;
          i.p = {x,
                 y,
                 2.0 * std::numbers::pi * d / directions,
                 std::log(width),
                 std::log(usual.depth * width),
                 std::log(0.3),
                 std::log(front),
                 tail > 0.0 ? std::log(tail) : 0.0};
          i.tailed = tail > 0.0;
          i.rounding = usual.rounding;
          const double energy = imprint_energy(i, samples, usual, options);
          if (energy < best.energy) best = {i, energy};
        }
    out.push_back(best);
  }
  return out;
}

}  // namespace dubsar
