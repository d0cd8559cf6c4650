#include "core/filter/estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/system/parallel.h"
#include "core/filter/mixture.h"
#include "core/filter/resample.h"
#include "tests/core/filter/filter_oracle.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

using oracle::make_volume;
using ::testing::HasSubstr;

struct Normal {
  double share, mean, sigma;
};

/// A volume whose voxels are drawn from normal distributions, in random places.
Volume<float> mixture_volume(const std::vector<Normal>& parts, std::uint64_t seed, std::int64_t n = 100) {
  oracle::Noise noise(seed);
  std::mt19937_64 random(seed + 1);
  return make_volume({n, n, n}, [&](auto, auto, auto) {
    double u = static_cast<double>(random() >> 11) / 9007199254740992.0;
    const Normal* part = parts.data();
    while (part + 1 != parts.data() + parts.size() && u >= part->share) u -= (part++)->share;
    return part->mean + part->sigma * noise();
  });
}

double density(const std::vector<Normal>& parts, double x) {
  double sum = 0.0;
  for (const Normal& p : parts)
    sum += p.share / p.sigma * std::exp(-0.5 * std::pow((x - p.mean) / p.sigma, 2)) / std::sqrt(2 * std::numbers::pi);
  return sum;
}

Estimates estimates_of(const Volume<float>& v, const EstimateOptions& options = {}) {
  VolumeSource source(v);
  SilentProgress silent;
  const auto e = estimate(source, options, silent);
  EXPECT_TRUE(e) << e.error().message;
  return *e;
}

/// The ways that were tried and what came of each; the last one was taken or none.
using Tried = std::vector<std::pair<SplitWay, SplitVerdict>>;
Tried tried(const Estimates& e) {
  Tried all;
  for (const SplitAttempt& attempt : e.attempts) {
    all.emplace_back(attempt.way, attempt.verdict);
    EXPECT_EQ(attempt.split.has_value(), attempt.verdict == SplitVerdict::kTaken);
    EXPECT_FALSE(attempt.reason.empty());
    EXPECT_THAT(e.path, HasSubstr(attempt.reason));
  }
  EXPECT_EQ(taken(e) != nullptr, e.refusal.empty());
  return all;
}
const Tried kTakenByPeaks{{SplitWay::kPeaks, SplitVerdict::kTaken}};

TEST(Estimate, TwoGaussiansAreFoundWithinTwoPercent) {
  for (const auto& [snr_db, scale] : {std::pair{17.0, 1.0}, {23.0, 0.0017}, {28.0, 30000.0}, {35.0, 1.0}}) {
    const double sigma = std::pow(10.0, -snr_db / 20.0);
    const Estimates e =
        estimates_of(mixture_volume({{0.6, 0.1 * scale, 0.8 * sigma * scale}, {0.4, 1.1 * scale, sigma * scale}}, 1));
    EXPECT_NEAR(e.m_lo, 0.1 * scale, 0.01 * scale);
    EXPECT_NEAR(e.m_hi, 1.1 * scale, 0.01 * scale);
    EXPECT_NEAR(e.sigma, sigma * scale, 0.02 * sigma * scale) << snr_db << " dB, scale " << scale;
    EXPECT_NEAR(e.snr_db, snr_db, 0.25);
    EXPECT_NEAR(e.snr_alt_db, snr_db / 2.0, 0.15);
    EXPECT_EQ(e.refusal, "");
    EXPECT_EQ(tried(e), kTakenByPeaks);
  }
}

TEST(Estimate, ThePapersThresholdIsWhereTheDensityIsTwiceThatOfTheValley) {
  const std::vector<Normal> parts{{0.5, 0.0, 0.16}, {0.5, 1.0, 0.13}};
  const Estimates e = estimates_of(mixture_volume(parts, 2, 128), {ThresholdMethod::kValley});
  double valley = 0.5, x = 0.0;
  for (double at = 0.2; at < 0.8; at += 1e-4)
    if (density(parts, at) < density(parts, valley)) valley = at;
  for (x = valley; density(parts, x) < 2.0 * density(parts, valley); x += 1e-5) {
  }
  EXPECT_NEAR(e.threshold, x, 0.02);
  EXPECT_EQ(e.threshold, e.threshold_valley);
  EXPECT_EQ(tried(e), kTakenByPeaks);
}

TEST(Estimate, TheOtherMethodsAgreeWithTheirFormulas) {
  const std::vector<Normal> parts{{0.7, 0.0, 0.12}, {0.3, 1.0, 0.12}};
  const Volume<float> v = mixture_volume(parts, 3);
  EXPECT_NEAR(estimates_of(v, {ThresholdMethod::kSigmas}).threshold, 1.0 - 3.0 * 0.12, 0.02);
  EXPECT_NEAR(estimates_of(v, {ThresholdMethod::kSigmas, 2.0}).threshold, 1.0 - 2.0 * 0.12, 0.02);
  EXPECT_NEAR(estimates_of(v, {ThresholdMethod::kHalf}).threshold, 0.5, 0.01);
  // Equal posterior of two normal distributions with the same width: middle + s^2 / contrast * ln(share / share).
  EXPECT_NEAR(estimates_of(v, {ThresholdMethod::kMixture}).threshold, 0.5 + 0.0144 * std::log(0.7 / 0.3), 0.01);
  EXPECT_NEAR(estimates_of(v, {ThresholdMethod::kOtsu}).threshold, 0.5, 0.03);
  EXPECT_NEAR(estimates_of(v).material_fraction, 0.3, 0.002);
}

TEST(Estimate, ACleanValleyDoesNotDragTheThresholdToTheFootOfThePeak) {
  // Partial-volume voxels fall off towards the material, as behind an edge-preserving filter.
  oracle::Noise noise(4);
  std::mt19937_64 random(5);
  const Volume<float> v = make_volume({100, 100, 100}, [&](auto x, auto, auto) {
    const double u = static_cast<double>(random() >> 11) / 9007199254740992.0;
    if (x % 10 == 0) return u * std::sqrt(u) * 0.85;
    return (x % 2 == 0 ? 0.0 : 1.0) + 0.03 * noise();
  });
  const Estimates e = estimates_of(v);
  EXPECT_GT(e.threshold_valley, 0.7);
  EXPECT_NEAR(e.threshold, 0.5, 0.01);
  EXPECT_EQ(tried(e), kTakenByPeaks);
}

TEST(Estimate, TheThresholdStaysBelowThreeSigmaOfTheMaterial) {
  const Estimates e = estimates_of(mixture_volume({{0.5, 0.0, 0.2}, {0.5, 1.0, 0.2}}, 6));
  EXPECT_GE(e.threshold, e.m_lo + kLeastOfContrast * (e.m_hi - e.m_lo));
  EXPECT_LE(e.threshold, std::max(e.m_lo + kLeastOfContrast * (e.m_hi - e.m_lo), e.m_hi - 3.0 * e.sigma) + 1e-12);
}

TEST(Estimate, TheShareOfAirAndScaleOfGreysDoNotMoveTheThreshold) {
  // A deep and flat valley, as filters leave it: partial volumes are few, where the fewest are is chance.
  const auto threshold = [](double air, double scale, double offset, std::uint64_t seed) {
    const double edge = 0.01;
    Volume<float> v = mixture_volume({{air - edge, 0.0, 0.02}, {1.0 - air, 1.0, 0.02}, {edge, -1.0, 0.0}}, seed, 80);
    oracle::Noise noise(seed + 7);
    for (float& value : v.voxels.span()) {
      if (value == -1.0f) value = static_cast<float>(0.5 + 0.2 * noise());
      value = static_cast<float>(offset + scale * static_cast<double>(value));
    }
    return (estimates_of(v).threshold - offset) / scale;
  };
  for (const double air : {0.3, 0.5, 0.7, 0.9})
    for (const std::uint64_t seed : {20u, 21u}) EXPECT_NEAR(threshold(air, 1.0, 0.0, seed), 0.5, 0.002) << air;
  for (const auto& [scale, offset] : {std::pair{3e-4, 0.0}, {8000.0, 1000.0}, {0.25, -1.0}, {1.0, 8.0}})
    EXPECT_NEAR(threshold(0.7, scale, offset, 20), threshold(0.7, 1.0, 0.0, 20), 0.002) << scale;
}

TEST(Estimate, ThreeModesGiveTheMostProminentPair) {  // a skull: air, tissue, a little bone
  const Estimates e = estimates_of(mixture_volume({{0.6, -1000, 12}, {0.35, 40, 15}, {0.05, 900, 150}}, 7));
  EXPECT_NEAR(e.m_lo, -1000, 15);
  EXPECT_NEAR(e.m_hi, 40, 15);
  EXPECT_NEAR(e.sigma, 15, 1.0);
}

TEST(Estimate, SaturatedVoxelsAreNoPeak) {  // .9 % of metal or glaze, more of a filled border, all at 65535
  for (const double share : {0.009, 0.3}) {
    Volume<float> v = mixture_volume(
        {{0.55 - 0.5 * share, 2000.0, 300.0}, {0.45 - 0.5 * share, 9000.0, 350.0}, {share, 65535.0, 0.0}}, 9);
    const Estimates e = estimates_of(v);
    EXPECT_NEAR(e.m_lo, 2000.0, 30.0) << share;
    EXPECT_NEAR(e.m_hi, 9000.0, 30.0) << share;
    EXPECT_NEAR(e.threshold, 5500.0, 360.0) << share;
    EXPECT_THAT(e.path, HasSubstr("at the largest value (65535) left out"));
  }
  // Clay itself at the end of the range of 8 bits: it stays the material.
  Volume<float> clipped = mixture_volume({{0.6, 60.0, 12.0}, {0.4, 254.0, 14.0}}, 10);
  for (float& value : clipped.voxels.span()) value = std::clamp(std::round(value), 0.0f, 255.0f);
  const Estimates e = estimates_of(clipped);
  EXPECT_NEAR(e.m_hi, 252.0, 6.0);
  EXPECT_NEAR(e.threshold, 155.0, 12.0);
}

TEST(Estimate, WhatIsNoMeasurementDoesNotCount) {
  const std::vector<Normal> parts{{0.7, 200.0, 40.0}, {0.3, 900.0, 40.0}};
  const Volume<float> whole = mixture_volume(parts, 11);
  const Estimates expected = estimates_of(whole);
  Volume<float> half = mixture_volume(parts, 11);
  constexpr float kFill = 203.00390625f;
  for (std::int64_t i = 0; i < half.voxels.size(); i += 2) half.voxels[i] = kFill;
  EstimateOptions options;
  options.left_out = kFill;
  const Estimates e = estimates_of(half, options);
  EXPECT_NEAR(e.m_lo, expected.m_lo, 0.5);
  EXPECT_NEAR(e.m_hi, expected.m_hi, 0.5);
  EXPECT_NEAR(e.sigma, expected.sigma, 0.5);
  EXPECT_NEAR(e.threshold, expected.threshold, 4.0);
  EXPECT_NEAR(e.material_fraction, expected.material_fraction, 0.002);
  VolumeSource source(half);
  SilentProgress silent;
  Volume<float> air = mixture_volume({{1.0, 200.0, 40.0}}, 12, 64);
  for (std::int64_t i = 0; i < air.voxels.size() / 3; ++i) air.voxels[i] = kFill;
  VolumeSource partly(air);
  EXPECT_NEAR(laplacian_noise(partly, silent, kFill).value(), 40.0, 2.0);
}

TEST(Estimate, IntegerScansHaveNoCombOfPeaks) {
  const Volume<float> fine = mixture_volume({{0.5, 40, 6}, {0.5, 90, 6}}, 8);
  const Volume<float> steps =
      make_volume(fine.dims, [&](auto x, auto y, auto z) { return std::round(fine.at(x, y, z)); });
  const Estimates e = estimates_of(steps);
  EXPECT_NEAR(e.m_lo, 40, 1);
  EXPECT_NEAR(e.m_hi, 90, 1);
  EXPECT_NEAR(e.sigma, std::sqrt(36.0 + 2.0 / 12.0), 0.2);
}

TEST(Estimate, OverlappingPeaksAreTakenApartAsAMixture) {
  const std::vector<Normal> parts{{0.8, 0.0, 1.0}, {0.2, 2.9, 1.0}};
  const Estimates e = estimates_of(mixture_volume(parts, 9));
  EXPECT_EQ(tried(e),
            (Tried{{SplitWay::kPeaks, SplitVerdict::kShallowValley}, {SplitWay::kMixture, SplitVerdict::kTaken}}));
  EXPECT_NEAR(e.m_hi, 2.9, 0.1);
  EXPECT_NEAR(e.sigma, 1.0, 0.05);
  EXPECT_NEAR(e.threshold, 1.45 + std::log(4.0) / 2.9, 0.1);
}

TEST(Estimate, AnUnclearHistogramFallsBackToOtsu) {
  // Half air with one value and little noise; the rest falls off smoothly, without a peak of its own.
  oracle::Noise noise(10);
  std::mt19937_64 random(11);
  const Volume<float> v = make_volume({80, 80, 80}, [&](auto, auto, auto) {
    const double u = static_cast<double>(random() >> 11) / 9007199254740992.0;
    return 0.05 * noise() + (random() % 10 < 1 ? -2.0 * std::log(1.0 - u) : 0.0);
  });
  const Estimates e = estimates_of(v);
  ASSERT_EQ(tried(e).size(), 3u);
  EXPECT_EQ(tried(e)[1], std::pair(SplitWay::kMixture, SplitVerdict::kNoFit));
  EXPECT_EQ(tried(e)[2], std::pair(SplitWay::kOtsu, SplitVerdict::kTaken));
  EXPECT_EQ(e.refusal, "") << e.path;
  EXPECT_GT(e.threshold, 1.0);
  EXPECT_GT(e.sigma, 0.08);
}

TEST(Estimate, OnePeakIsRefusedInOneSentenceAndItsNoiseMeasured) {
  const Estimates e = estimates_of(mixture_volume({{1.0, 5.0, 0.25}}, 12));
  const auto tau = automatic_threshold(e);
  ASSERT_FALSE(tau);
  EXPECT_EQ(tau.error().kind, ErrorKind::kBadData);
  EXPECT_EQ(tried(e), (Tried{{SplitWay::kPeaks, SplitVerdict::kShallowValley},
                             {SplitWay::kMixture, SplitVerdict::kNoFit},
                             {SplitWay::kOtsu, SplitVerdict::kNotApart}}));
  EXPECT_EQ(e.threshold, 0.0);
  EXPECT_EQ(e.m_hi, 0.0);
  EXPECT_NEAR(e.sigma, 0.25, 0.005);  // Laplacian of white noise
}

TEST(Estimate, ATraceOfMaterialIsRefused) {
  const Estimates e = estimates_of(mixture_volume({{0.998, 0.0, 0.05}, {0.002, 1.0, 0.05}}, 13));
  EXPECT_FALSE(automatic_threshold(e)) << e.path;
  EXPECT_NEAR(e.sigma, 0.05, 0.001);
}

TEST(Estimate, ConstantAndEmptyVolumesAreRefused) {
  for (const float value : {0.0F, 3.5F, 1e-42F, -3e38F}) {
    const Estimates e = estimates_of(make_volume({8, 8, 8}, [&](auto, auto, auto) { return value; }));
    EXPECT_THAT(e.refusal, HasSubstr("all voxels have the value"));
  }
  const Volume<float> nan = make_volume({4, 4, 4}, [](auto, auto, auto) { return std::nan(""); });
  VolumeSource source(nan);
  SilentProgress silent;
  const auto e = estimate(source, {}, silent);
  ASSERT_FALSE(e);
  EXPECT_EQ(e.error().kind, ErrorKind::kBadData);
}

TEST(Estimate, AVolumeOfTwoValuesIsSplitHalfWay) {
  const Volume<float> v = make_volume({16, 16, 16}, [](auto x, auto, auto) { return x < 5 ? 3.0 : 11.0; });
  const Estimates e = estimates_of(v);
  EXPECT_NEAR(e.threshold, 7.0, 0.4);
  EXPECT_NEAR(e.material_fraction, 11.0 / 16.0, 1e-6);
}

TEST(Estimate, HugeAndDenormalRangesGiveFiniteNumbers) {
  for (const double top : {3e38, 1e-38, 1e-43}) {
    const Volume<float> v = make_volume({20, 20, 20}, [&](auto x, auto y, auto) { return (x + y) % 3 ? top : -top; });
    const Estimates e = estimates_of(v);
    EXPECT_TRUE(std::isfinite(e.threshold) && std::isfinite(e.sigma) && std::isfinite(e.snr_db)) << top;
    EXPECT_LT(std::abs(e.threshold), top);
  }
}

TEST(Estimate, TheDefaultThresholdLiesOnTheSurface) {
  // A flat wall across the x axis, blurred and noisy, through resampling and the default filter.
  const Dims raw{80, 100, 100};
  const double wall = 40.3, blur = 0.8;
  const Volume<float> noise = oracle::correlated_noise(raw, std::pow(10.0, -17.0 / 20.0), 14);
  const Volume<float> scan = make_volume(raw, [&](auto x, auto y, auto z) {
    const double tilt = 0.02 * static_cast<double>(y) + 0.01 * static_cast<double>(z);
    return 0.5 * std::erfc(-(static_cast<double>(x) - wall - tilt) / blur / std::numbers::sqrt2) + noise.at(x, y, z);
  });
  VolumeSource source(scan);
  HalfResolutionSource half(source);
  Volume<float> v = testing::read_all(half, 16).value();
  SilentProgress silent;
  ASSERT_TRUE(denoise_in_place(v, {.sigma = estimates_of(v).sigma}, silent));
  // Mean distance of the isosurface from the wall in voxels of the resampled grid.
  const auto bias = [&](ThresholdMethod method) {
    const double tau = estimates_of(v, {method}).threshold;
    double sum = 0.0, count = 0.0;
    for (std::int64_t z = 3; z < v.dims.z - 3; ++z)
      for (std::int64_t y = 3; y < v.dims.y - 3; ++y)
        for (std::int64_t x = 15; x < 30; ++x) {
          const double a = v.at(x, y, z), b = v.at(x + 1, y, z);
          if (!(a < tau && b >= tau)) continue;
          const glm::dvec3 at = half.frame().input_vox_from_grid({static_cast<double>(x) + (tau - a) / (b - a), y, z});
          sum += (at.x - wall - 0.02 * at.y - 0.01 * at.z) / 2.0;
          count += 1.0;
        }
    return sum / count;
  };
  EXPECT_NEAR(bias(ThresholdMethod::kAuto), 0.0, 0.03);
  EXPECT_NEAR(bias(ThresholdMethod::kHalf), 0.0, 0.03);
  EXPECT_GT(bias(ThresholdMethod::kValley), 0.3);  // why the valley rule alone is not the default
}

TEST(Mixture, OtsuCutsAnEmptyValleyInTheMiddle) {
  Histogram h{0.0, 1.0, std::vector<double>(100, 0.0), 0.0};
  h.mass[10] = 5.0;
  h.mass[70] = 3.0;
  const OtsuSplit split = otsu_split(h);
  EXPECT_NEAR(split.threshold, 40.5, 1e-9);
  EXPECT_NEAR(split.share_hi, 3.0 / 8.0, 1e-12);
  EXPECT_NEAR(split.separability, 1.0, 1e-2);
}

TEST(Mixture, ASingleGaussianHasTheKnownSeparability) {
  Histogram h{-4.0, 0.01, {}, 0.0};
  for (int i = 0; i < 800; ++i) h.mass.push_back(std::exp(-0.5 * std::pow(h.centre(i), 2)));
  EXPECT_NEAR(otsu_split(h).separability, 2.0 / std::numbers::pi, 2e-3);
}

TEST(Mixture, ThreeGaussiansComeBack) {
  Histogram h{0.0, 0.01, {}, 0.0};
  const std::vector<Normal> parts{{0.5, 2.0, 0.4}, {0.2, 5.0, 0.5}, {0.3, 8.0, 0.3}};
  for (int i = 0; i < 1000; ++i) h.mass.push_back(density(parts, h.centre(i)));
  const Mixture m = fit_mixture(h, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(m.components[k].mean, parts[k].mean, 0.01);
    EXPECT_NEAR(m.components[k].sigma, parts[k].sigma, 0.01);
    EXPECT_NEAR(m.components[k].weight, parts[k].share, 0.01);
  }
  EXPECT_LT(m.plateau, 0.01);
}

}  // namespace
}  // namespace dubsar
