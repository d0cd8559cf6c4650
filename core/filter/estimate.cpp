#include "core/filter/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/filter/mixture.h"

namespace dubsar {
namespace {

// Where the threshold stands. A ball in a shell with a gap of 0 to 4 voxels between them, blurred, 17 dB, Gauss and
// 2:1, two joint bilateral iterations; distance of the isosurface from the true one in voxels (bias of the outer
// surface, its rms, share of the gap of 0.5 to 1 voxel that is closed):
//     threshold of 0..1   0.50             0.55             0.60             0.70             0.85 (valley rule alone)
//     bias, rms           -0.01, 0.07      -0.09, 0.11      -0.17, 0.19      -0.35, 0.36      -0.67, 0.68
//     gap closed          88 %             70 %             51 %             20 %             0 %
// A symmetric blur leaves the half level where the surface is. The valley rule follows the emptying valley up to the
// foot of the material's peak as the filters take the noise away: it keeps gaps open and eats 0.7 voxel of everything
// else. Surfaces count more, and glued parts are separated later by shape: the threshold is the half level. Where the
// valley is deep and flat its least density is chance, and a rule that begins there moves the surface with the share of
// air in the scan: cropping a margin moved it by .05 of the contrast.

// Tried on phantoms and on public scans.
constexpr double kBandwidth = 0.004;       // of the histogram's range: finds peaks
constexpr double kDeepestValley = 0.8;     // density of the valley / of the lower peak, above it there is one peak only
constexpr double kLeastProminence = 0.05;  // of the lower peak
constexpr double kLeastShare = 0.005;      // of the voxels, for air and for material
constexpr double kLeastSeparation = 2.0;   // Ashman's D of two Gaussians
constexpr double kLargestMisfit = 0.01;    // of a mixture, in parts of the voxels
constexpr double kLeastSaturated = 0.001;  // of the voxels, at one value
constexpr double kSpike = 4.0;             // times as many as in the hundredth of the range below it
constexpr double kLeastNoise = 0.005;      // of the contrast: less is a drawing, whose values are all spikes
constexpr double kLeastSeparability = 0.7;  // Otsu; a single Gaussian has 0.64

/// The histogram convolved with a Gaussian of `sigma` bins.
std::vector<double> smoothed(const Histogram& h, double sigma) {
  const auto reach = static_cast<std::int64_t>(std::ceil(5.0 * sigma));
  std::vector<double> kernel(static_cast<std::size_t>(reach + 1));
  double sum = 0.0;
  for (std::int64_t k = 0; k <= reach; ++k) {
    const double t = static_cast<double>(k) / sigma;
    kernel[static_cast<std::size_t>(k)] = std::exp(-0.5 * t * t);
    sum += kernel[static_cast<std::size_t>(k)] * (k == 0 ? 1.0 : 2.0);
  }
  const auto bins = static_cast<std::int64_t>(h.mass.size());
  std::vector<double> out(h.mass.size(), 0.0);
  for (std::int64_t i = 0; i < bins; ++i)
    for (std::int64_t k = std::max<std::int64_t>(-reach, -i); k <= std::min(reach, bins - 1 - i); ++k)
      out[static_cast<std::size_t>(i)] +=
          h.mass[static_cast<std::size_t>(i + k)] * kernel[static_cast<std::size_t>(std::abs(k))] / sum;
  return out;
}

double at(const std::vector<double>& pd, std::int64_t bin) {
  return bin < 0 || bin >= static_cast<std::int64_t>(pd.size()) ? 0.0 : pd[static_cast<std::size_t>(bin)];
}

/// Top of the parabola through a peak bin and its neighbours, in bins.
double refined(const std::vector<double>& pd, std::int64_t bin) {
  const double a = at(pd, bin - 1), b = at(pd, bin), c = at(pd, bin + 1), bend = a - 2.0 * b + c;
  return static_cast<double>(bin) + (bend < 0.0 ? 0.5 * (a - c) / bend : 0.0);
}

struct PeakPair {
  std::int64_t low = 0, valley = 0, high = 0;  ///< bins
  double valley_ratio = 0.0;                   ///< valley / lower peak
};

/// The two local maxima with the deepest valley between them, measured from the lower one.
std::optional<PeakPair> most_prominent_pair(const std::vector<double>& pd) {
  std::vector<std::int64_t> peaks;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(pd.size()); ++i)
    if (at(pd, i) > at(pd, i - 1) && at(pd, i) >= at(pd, i + 1)) peaks.push_back(i);
  std::optional<PeakPair> best;
  double best_depth = 0.0;
  for (std::size_t a = 0; a < peaks.size(); ++a) {
    std::int64_t valley = peaks[a];
    for (std::size_t b = a + 1; b < peaks.size(); ++b) {
      for (std::int64_t i = peaks[b - 1]; i < peaks[b]; ++i)
        if (at(pd, i) < at(pd, valley)) valley = i;
      const double lower = std::min(at(pd, peaks[a]), at(pd, peaks[b]));
      if (lower - at(pd, valley) > best_depth) {
        best_depth = lower - at(pd, valley);
        best = PeakPair{peaks[a], valley, peaks[b], at(pd, valley) / lower};
      }
    }
  }
  return best;
}

struct Top {
  double bin = 0.0, density = 0.0;
};

/// Top of the parabola through the logarithm of the density within 0.7 `sigma` of a peak: exact for a Gaussian, and
/// steadier than the highest bin, which wanders on the flat top of a wide peak.
Top fitted_top(const std::vector<double>& pd, std::int64_t peak, double sigma) {
  const auto reach = static_cast<std::int64_t>(0.7 * sigma);
  const Top highest{refined(pd, peak), at(pd, peak)};
  if (reach < 2) return highest;
  double m0 = 0.0, m1 = 0.0, m2 = 0.0, m3 = 0.0, m4 = 0.0, y0 = 0.0, y1 = 0.0, y2 = 0.0;
  for (std::int64_t k = -reach; k <= reach; ++k) {
    const double w = at(pd, peak + k), t = static_cast<double>(k) / sigma;
    if (w <= 0.0) continue;
    const double y = std::log(w / highest.density);
    m0 += w, m1 += w * t, m2 += w * t * t, m3 += w * t * t * t, m4 += w * t * t * t * t;
    y0 += w * y, y1 += w * t * y, y2 += w * t * t * y;
  }
  const double determinant = m0 * (m2 * m4 - m3 * m3) - m1 * (m1 * m4 - m2 * m3) + m2 * (m1 * m3 - m2 * m2);
  if (!(std::abs(determinant) > 1e-12 * m0 * m0 * m0)) return highest;
  const double a = (y0 * (m2 * m4 - m3 * m3) - m1 * (y1 * m4 - y2 * m3) + m2 * (y1 * m3 - y2 * m2)) / determinant;
  const double b = (m0 * (y1 * m4 - y2 * m3) - y0 * (m1 * m4 - m2 * m3) + m2 * (m1 * y2 - m2 * y1)) / determinant;
  const double c = (m0 * (m2 * y2 - m3 * y1) - m1 * (m1 * y2 - m2 * y1) + y0 * (m1 * m3 - m2 * m2)) / determinant;
  const double t = -0.5 * b / c;
  if (!(c < 0.0) || std::abs(t) > 0.7) return highest;
  return {static_cast<double>(peak) + t * sigma, highest.density * std::exp(a - 0.25 * b * b / c)};
}

/// Distance in bins from the top, in direction `step`, to where the density is e^-1/2 of the top's; at most to `end`.
std::optional<double> half_width(const std::vector<double>& pd, const Top& top, std::int64_t step, std::int64_t end) {
  const double target = std::exp(-0.5) * top.density;
  for (auto i = static_cast<std::int64_t>(std::lround(top.bin)); i != end; i += step) {
    const double here = at(pd, i), next = at(pd, i + step);
    if (here > target && next <= target)
      return std::abs(static_cast<double>(i) + static_cast<double>(step) * (here - target) / (here - next) - top.bin);
  }
  return std::nullopt;
}

struct PeakShape {
  double bin = 0.0, sigma = 0.0;  ///< bins
  bool outer = false;             ///< measured on the slope away from the valley
};

/// The paper's sigma: from a peak to e^-1/2 of its density on the slope towards the valley. Done again with a bandwidth
/// that follows the width found, whose share is taken off: smoothing widens a Gaussian from s^2 to s^2 + h^2.
std::optional<PeakShape> measure_peak(const Histogram& h, std::int64_t peak, std::int64_t valley, double coarse) {
  std::optional<PeakShape> found;
  double bandwidth = coarse;
  const std::int64_t inwards = valley < peak ? -1 : 1, last = static_cast<std::int64_t>(h.mass.size()) - 1;
  for (int round = 0; round < 4; ++round) {
    const std::vector<double> pd = smoothed(h, bandwidth);
    const auto reach = static_cast<std::int64_t>(std::ceil(found ? 0.5 * found->sigma : bandwidth));
    std::int64_t highest = std::clamp<std::int64_t>(peak - reach, 0, last);
    for (std::int64_t i = highest; i <= std::min(last, peak + reach); ++i)
      if (at(pd, i) > at(pd, highest)) highest = i;
    peak = highest;
    const Top top = fitted_top(pd, peak, found ? found->sigma : 0.0);
    bool outer = false;
    std::optional<double> width = half_width(pd, top, inwards, valley);
    if (!width) {
      width = half_width(pd, top, -inwards, inwards < 0 ? last + 1 : -1);
      outer = true;
    }
    if (!width) return found;
    const double sigma = std::sqrt(std::max(*width * *width - bandwidth * bandwidth, 0.04));
    found = PeakShape{top.bin, sigma, outer};
    bandwidth = std::max(sigma / 3.0, 0.5);
  }
  return found;
}

/// The paper's threshold: from the valley upwards to the first place with `factor` times the valley's density.
double valley_rule(const Histogram& h, const std::vector<double>& pd, const PeakPair& pair, double factor) {
  const double target = factor * at(pd, pair.valley);
  for (std::int64_t i = pair.valley; i < pair.high; ++i) {
    const double here = at(pd, i), next = at(pd, i + 1);
    if (next >= target && next > here) return h.centre(static_cast<double>(i) + (target - here) / (next - here));
  }
  return h.centre(static_cast<double>(pair.high));
}

double share_above(const Histogram& h, double threshold) {
  double below = 0.0, inside = 0.0;
  for (std::size_t i = 0; i < h.mass.size(); ++i) {
    inside += h.mass[i];
    below += h.mass[i] * std::clamp((threshold - h.low) / h.width - static_cast<double>(i), 0.0, 1.0);
  }
  return inside > 0.0 ? (inside - below) / inside : 0.0;
}

bool two_classes(double share) { return share >= kLeastShare && share <= 1.0 - kLeastShare; }

SplitAttempt refused(SplitWay way, SplitVerdict verdict, std::string reason) {
  return {way, verdict, std::nullopt, std::move(reason)};
}

/// The threshold between two measured peaks, and how it was set.
std::pair<double, std::string> between_peaks(const Split& split, const EstimateOptions& options) {
  const double contrast = split.m_hi - split.m_lo;
  switch (options.method) {
    case ThresholdMethod::kValley:
      return {split.threshold_valley, "threshold by the valley rule, not capped"};
    case ThresholdMethod::kSigmas:
      return {split.m_hi - (options.factor > 0.0 ? options.factor : 3.0) * split.sigma,
              "threshold some sigmas below the upper peak"};
    case ThresholdMethod::kHalf:
      return {split.m_lo + 0.5 * contrast, "threshold half way between them"};
    default:
      break;
  }
  const double half = split.m_lo + 0.5 * contrast, clear = split.m_hi - 3.0 * split.sigma;
  if (clear >= half) return {half, "threshold half way between them"};
  return {std::max(clear, split.m_lo + kLeastOfContrast * contrast),
          "threshold three sigmas below the upper peak, or .45 of the way to it"};
}

/// Two peaks as in the paper.
SplitAttempt by_peaks(const Histogram& h, const EstimateOptions& options) {
  constexpr SplitWay kWay = SplitWay::kPeaks;
  const double coarse = kBandwidth * static_cast<double>(h.mass.size());
  const std::vector<double> pd = smoothed(h, coarse);
  const std::optional<PeakPair> pair = most_prominent_pair(pd);
  if (!pair) return refused(kWay, SplitVerdict::kOnePeak, "the histogram has one peak");
  if (pair->valley_ratio > std::min(kDeepestValley, 1.0 - kLeastProminence))
    return refused(kWay, SplitVerdict::kShallowValley,
                   fmt::format("the valley between the peaks has {:.0f} % of the lower peak's density",
                               100.0 * pair->valley_ratio));
  const std::optional<PeakShape> lower = measure_peak(h, pair->low, pair->valley, coarse);
  const std::optional<PeakShape> upper = measure_peak(h, pair->high, pair->valley, coarse);
  if (!lower || !upper || !(lower->bin < upper->bin))
    return refused(kWay, SplitVerdict::kNoSlope, "a peak has no slope");
  Split split;
  split.m_lo = h.centre(lower->bin);
  split.m_hi = h.centre(upper->bin);
  split.sigma = upper->sigma * h.width;
  const bool factor_is_other = options.method == ThresholdMethod::kSigmas || options.factor <= 0.0;
  split.threshold_valley = valley_rule(h, pd, *pair, factor_is_other ? 2.0 : options.factor);
  const auto [threshold, how] = between_peaks(split, options);
  split.threshold = threshold;
  split.material_fraction = share_above(h, threshold);
  if (options.method == ThresholdMethod::kAuto && !two_classes(split.material_fraction))
    return refused(kWay, SplitVerdict::kOneClass,
                   fmt::format("the peaks split the voxels {:.2f} % to {:.2f} %",
                               100.0 * (1.0 - split.material_fraction), 100.0 * split.material_fraction));
  return {kWay, SplitVerdict::kTaken, split,
          fmt::format("two peaks{}; {}", upper->outer ? ", sigma from its outer slope" : "", how)};
}

/// Half the sum of absolute differences between the smoothed histogram and the mixture, both with mass 1.
double misfit(const Histogram& h, const Mixture& m) {
  const double bandwidth = kBandwidth * static_cast<double>(h.mass.size());
  const std::vector<double> pd = smoothed(h, bandwidth);
  double total = 0.0, sum = 0.0;
  for (const double mass : pd) total += mass;
  const double left = m.components.front().mean, right = m.components.back().mean;
  for (std::size_t i = 0; i < pd.size(); ++i) {
    const double x = h.centre(static_cast<double>(i));
    double expected = x > left && x < right ? m.plateau / (right - left) : 0.0;
    for (Mixture::Component c : m.components) {
      c.sigma = std::hypot(c.sigma, bandwidth * h.width);
      expected += density(c, x);
    }
    sum += std::abs(pd[i] / total - expected * h.width);
  }
  return 0.5 * sum;
}

SplitAttempt by_mixture(const Histogram& h) {
  for (const int count : {2, 3}) {
    const Mixture m = fit_mixture(h, count);
    const Mixture::Component& low = m.components[m.components.size() - 2];
    const Mixture::Component& high = m.components.back();
    const double between = equal_posterior(low, high), share = share_above(h, between);
    if (separation(low, high) < kLeastSeparation || low.weight < kLeastShare || high.weight < kLeastShare ||
        !(misfit(h, m) <= kLargestMisfit) || !two_classes(share))
      continue;
    return {SplitWay::kMixture, SplitVerdict::kTaken, Split{low.mean, high.mean, high.sigma, between, 0.0, share},
            fmt::format("threshold from a mixture of {} Gaussians", count)};
  }
  return refused(SplitWay::kMixture, SplitVerdict::kNoFit, "no mixture of Gaussians fits");
}

SplitAttempt by_otsu(const Histogram& h, double laplacian_sigma, bool asked_for) {
  const OtsuSplit split = otsu_split(h);
  if (!asked_for && (split.separability < kLeastSeparability || !two_classes(split.share_hi)))
    return refused(SplitWay::kOtsu, SplitVerdict::kNotApart,
                   fmt::format("Otsu's classes are not apart (separability {:.2f})", split.separability));
  return {SplitWay::kOtsu, SplitVerdict::kTaken,
          Split{split.mean_lo, split.mean_hi, laplacian_sigma, split.threshold, 0.0, split.share_hi},
          "threshold by Otsu, sigma from the Laplacian"};
}

/// Until one is taken.
std::vector<SplitAttempt> try_ways(const Histogram& h, double laplacian_sigma, const EstimateOptions& options) {
  switch (options.method) {
    case ThresholdMethod::kOtsu:
      return {by_otsu(h, laplacian_sigma, true)};
    case ThresholdMethod::kMixture:
      return {by_mixture(h)};
    case ThresholdMethod::kAuto:
      break;
    default:
      return {by_peaks(h, options)};
  }
  std::vector<SplitAttempt> attempts{by_peaks(h, options)};
  if (!attempts.back().split) attempts.push_back(by_mixture(h));
  if (!attempts.back().split) attempts.push_back(by_otsu(h, laplacian_sigma, false));
  return attempts;
}

/// What lies above the range of its file, all at its largest value, is no material: without that spike, where it is one
/// and the histogram has two peaks with noise beside it.
std::optional<Estimates> without_saturated(std::span<const ValueCounts::Value> values, const EstimateOptions& options) {
  if (values.size() < 3) return std::nullopt;
  const ValueCounts::Value& top = values.back();
  const double near = top.centre - 0.01 * (top.centre - values.front().centre);
  double all = 0.0, beside = 0.0;
  for (const ValueCounts::Value& v : values) {
    all += static_cast<double>(v.count);
    if (v.centre >= near) beside += static_cast<double>(v.count);
  }
  const auto saturated = static_cast<double>(top.count);
  if (saturated < kLeastSaturated * all || saturated < kSpike * (beside - saturated)) return std::nullopt;
  Estimates e = estimate(make_histogram(values.first(values.size() - 1)), 0.0, options);
  const SplitAttempt* const way = taken(e);
  if (way == nullptr || way->way != SplitWay::kPeaks || e.sigma < kLeastNoise * (e.m_hi - e.m_lo)) return std::nullopt;
  e.path = fmt::format("{:.2f} % of the voxels at the largest value ({:.6g}) left out; {}", 100.0 * saturated / all,
                       top.centre, e.path);
  return e;
}

}  // namespace

Estimates estimate(const Histogram& h, double laplacian_sigma, const EstimateOptions& options) {
  Estimates e;
  if (h.mass.size() < 2) {
    e.m_lo = e.m_hi = h.low;
    e.path = "all voxels are equal";
    e.refusal = fmt::format(
        "threshold: all voxels have the value {:.6g}, expected air and material; choose another dataset", h.low);
    return e;
  }
  e.attempts = try_ways(h, laplacian_sigma, options);
  for (const SplitAttempt& attempt : e.attempts) e.path += (e.path.empty() ? "" : "; ") + attempt.reason;
  const SplitAttempt* const way = taken(e);
  if (way == nullptr) {
    e.sigma = laplacian_sigma;
    e.refusal = fmt::format("threshold: cannot tell material from air ({}), set the threshold", e.path);
    return e;
  }
  const Split& split = *way->split;
  e.m_lo = split.m_lo;
  e.m_hi = split.m_hi;
  e.sigma = split.sigma;
  e.threshold = split.threshold;
  e.threshold_valley = split.threshold_valley;
  e.material_fraction = split.material_fraction;
  if (e.sigma > 0.0 && e.m_hi > e.m_lo) {
    e.snr_db = 20.0 * std::log10((e.m_hi - e.m_lo) / e.sigma);
    e.snr_alt_db = 0.5 * e.snr_db;
  }
  return e;
}

const SplitAttempt* taken(const Estimates& estimates) noexcept {
  return !estimates.attempts.empty() && estimates.attempts.back().split ? &estimates.attempts.back() : nullptr;
}

Result<Estimates> estimate(SlabSource& source, const EstimateOptions& options, Progress& progress) {
  DUBSAR_ASSIGN(const ValueCounts counts, count_values(source, progress));
  return estimate(counts, source, options, progress);
}

Result<Estimates> estimate(const ValueCounts& counts, SlabSource& source, const EstimateOptions& options,
                           Progress& progress) {
  if (counts.count() == 0)
    return fail(ErrorKind::kBadData, "threshold: the volume has no finite voxel, choose another dataset");
  std::vector<ValueCounts::Value> values = counts.values();
  if (options.left_out)
    std::erase_if(values,
                  [none = ValueCounts::centre_of(*options.left_out)](const auto& v) { return v.centre == none; });
  if (auto without = without_saturated(values, options)) return *std::move(without);
  const Histogram histogram = make_histogram(values);
  Estimates first = estimate(histogram, 0.0, options);
  if (first.sigma > 0.0 || histogram.mass.empty()) return first;
  DUBSAR_ASSIGN(const double sigma, laplacian_noise(source, progress, options.left_out));
  return estimate(histogram, sigma, options);
}

Result<double> automatic_threshold(const Estimates& estimates) {
  if (!estimates.refusal.empty()) return fail(ErrorKind::kBadData, "{}", estimates.refusal);
  return estimates.threshold;
}

}  // namespace dubsar
