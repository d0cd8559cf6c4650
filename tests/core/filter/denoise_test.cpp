#include "core/filter/denoise.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>

#include "core/base/system/parallel.h"
#include "core/filter/resample.h"
#include "tests/core/filter/filter_oracle.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

using oracle::make_volume;
using testing::read_all;

Volume<float> denoised(const Volume<float>& v, const DenoiseOptions& options, std::int64_t height = 1000) {
  VolumeSource source(v);
  auto filter = make_denoised(source, options);
  EXPECT_TRUE(filter) << filter.error().message;
  return read_all(**filter, height).value();
}

struct NoiseCase {
  DenoiseOptions options;
  std::string name;
};

std::vector<NoiseCase> all_filters(int iterations, double sigma) {
  std::vector<NoiseCase> cases;
  for (const int window : {3, 5, 7}) {
    for (const auto& method : kDenoiseMethods)
      for (const auto& range : kRangeWeights) {
        if (!needs_sigma(method.value) && range.value != RangeWeight::kTukey) continue;
        cases.push_back({{method.value, range.value, window, iterations, sigma},
                         fmt::format("{} {} {}", method.name, range.name, window)});
      }
  }
  return cases;
}

TEST(Denoise, EveryFilterAgreesWithItsDefinition) {
  oracle::Noise noise(1);
  for (const Dims dims : {Dims{37, 6, 5}, Dims{3, 2, 1}, Dims{1, 9, 2}, Dims{17, 1, 8}}) {
    const Volume<float> v = make_volume(dims, [&](auto x, auto, auto) { return (x > 11 ? 5.0 : 0.0) + noise(); });
    for (const NoiseCase& c : all_filters(1, 1.1)) {
      const Volume<float> out = denoised(v, c.options);
      const Volume<double> expected = oracle::denoise_once(v, c.options);
      for (std::int64_t i = 0; i < dims.count(); ++i)
        ASSERT_NEAR(out.voxels[i], expected.voxels[i], 4e-6) << c.name << " voxel " << i << " of " << dims.x;
    }
  }
}

TEST(Denoise, EveryInstructionSetAgreesWithTheDefinitionAndWithTheOthers) {
  oracle::Noise noise(7);
  const Volume<float> v = make_volume({41, 5, 4}, [&](auto x, auto, auto) { return (x > 11 ? 5.0 : 0.0) + noise(); });
  VolumeSource source(v);
  HalfResolutionSource half(source);
  const Volume<float> expected_half = read_all(half, 2).value();
  set_thread_count(1);
  const auto choose = [](std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  };
  const std::int64_t all = hwy::SupportedTargets();
  for (const NoiseCase& c : all_filters(1, 1.1)) {
    const Volume<double> expected = oracle::denoise_once(v, c.options);
    std::optional<Volume<float>> first;
    for (std::int64_t left = all; left != 0; left &= left - 1) {
      choose(left & -left);
      Volume<float> out = denoised(v, c.options);
      for (std::int64_t i = 0; i < v.dims.count(); ++i)
        EXPECT_NEAR(out.voxels[i], expected.voxels[i], 4e-6) << c.name << " with " << hwy::TargetName(left & -left);
      const bool exponentials = needs_sigma(c.options.method) && c.options.range == RangeWeight::kGauss;
      if (!first) {
        first = std::move(out);
      } else if (!exponentials) {  // those of the library round differently
        EXPECT_EQ(0, std::memcmp(out.voxels.data(), first->voxels.data(), out.voxels.span().size_bytes()))
            << c.name << " with " << hwy::TargetName(left & -left);
      }
    }
  }
  for (std::int64_t left = all; left != 0; left &= left - 1) {
    choose(left & -left);
    HalfResolutionSource again(source);
    const Volume<float> out = read_all(again, 2).value();
    EXPECT_EQ(0, std::memcmp(out.voxels.data(), expected_half.voxels.data(), out.voxels.span().size_bytes()))
        << hwy::TargetName(left & -left);
  }
  choose(0);
  set_thread_count(0);
}

TEST(Denoise, WhatIsWantedIsTheSameToTheBitAsInTheWhole) {
  oracle::Noise noise(23);
  const Dims dims{83, 30, 27};
  const Volume<float> v = make_volume(dims, [&](auto x, auto, auto) { return (x > 41 ? 5.0 : 0.0) + noise(); });
  BrickMask mask(dims);
  mask.set(0, 0, 0);  // at a corner, in the middle, beside another, at the last voxels
  mask.set(4, 2, 1);
  mask.set(5, 2, 1);
  mask.set(10, 3, 3);
  for (const NoiseCase& c : all_filters(2, 1.1)) {
    const Volume<float> whole = denoised(v, c.options);
    for (const std::int64_t reach : {0, 2}) {
      VolumeSource source(v);
      const auto filter = make_denoised(source, c.options, {&mask, reach});
      ASSERT_TRUE(filter) << filter.error().message;
      const Volume<float> part = read_all(**filter, 4).value();
      std::vector<Span> spans;
      for (std::int64_t z = 0; z < dims.z; ++z)
        for (std::int64_t y = 0; y < dims.y; ++y) {
          mask.spans(y, z, reach, spans);
          for (const Span& span : spans)
            ASSERT_EQ(0, std::memcmp(part.row(y, z) + span.begin, whole.row(y, z) + span.begin,
                                     static_cast<std::size_t>(span.end - span.begin) * sizeof(float)))
                << c.name << " reach " << reach << " row " << y << ' ' << z << " from " << span.begin;
        }
    }
  }
}

TEST(Denoise, SlabHeightAndThreadsChangeNoBit) {
  oracle::Noise noise(2);
  const Volume<float> v = make_volume({41, 18, 13}, [&](auto x, auto, auto) { return (x > 20 ? 6.0 : 0.0) + noise(); });
  for (const NoiseCase& c : all_filters(2, 1.0)) {
    set_thread_count(1);
    const Volume<float> expected = denoised(v, c.options);
    for (const auto& [threads, height] : {std::pair{1, 2}, std::pair{2, 1}, std::pair{7, 5}}) {
      set_thread_count(threads);
      const Volume<float> out = denoised(v, c.options, height);
      EXPECT_EQ(0, std::memcmp(out.voxels.data(), expected.voxels.data(), out.voxels.span().size_bytes()))
          << c.name << ", " << threads << " threads, slabs of " << height;
    }
    Volume<float> here = make_volume(v.dims, [&](auto x, auto y, auto z) { return v.at(x, y, z); });
    SilentProgress silent;
    ASSERT_TRUE(denoise_in_place(here, c.options, silent));
    EXPECT_EQ(0, std::memcmp(here.voxels.data(), expected.voxels.data(), here.voxels.span().size_bytes()))
        << c.name << ", in place";
  }
  set_thread_count(0);
}

TEST(Denoise, SlabsOfALargeSliceAreTheSameToo) {  // several batches of the ring buffers, tiles that do not divide
  oracle::Noise noise(3);
  const Volume<float> v = make_volume({530, 171, 40}, [&](auto, auto, auto) { return noise(); });
  const DenoiseOptions options{.sigma = 1.0};
  const Volume<float> expected = denoised(v, options);
  const Volume<float> out = denoised(v, options, 3);
  EXPECT_EQ(0, std::memcmp(out.voxels.data(), expected.voxels.data(), out.voxels.span().size_bytes()));
  Volume<float> here = make_volume(v.dims, [&](auto x, auto y, auto z) { return v.at(x, y, z); });
  SilentProgress silent;
  ASSERT_TRUE(denoise_in_place(here, options, silent));
  EXPECT_EQ(0, std::memcmp(here.voxels.data(), expected.voxels.data(), here.voxels.span().size_bytes()));
}

TEST(Denoise, ConstantsStay) {
  for (const float value : {0.0F, 0.0017F, -1024.3F, 1e-40F, 5e36F, 3e38F}) {
    const Volume<float> v = make_volume({19, 8, 7}, [&](auto, auto, auto) { return value; });
    for (const NoiseCase& c : all_filters(3, 0.0001)) {
      const Volume<float> result = denoised(v, c.options);
      for (const float out : result.voxels.span())
        ASSERT_NEAR(out, value, std::abs(value) * 1e-6F + 1e-44F) << c.name << " of " << value;
    }
  }
}

TEST(Denoise, HugeRangesAndDenormalsStayFiniteAndInsideTheRange) {
  set_thread_count(1);  // the volumes are small and many
  const float big = std::numeric_limits<float>::max();
  for (const float top : {big, 1e30F, 1e-38F, 1e-44F}) {
    const Volume<float> v =
        make_volume({35, 9, 9}, [&](auto x, auto y, auto z) { return (x * 7 + y * 3 + z) % 5 < 2 ? top : -top; });
    for (const double sigma : {1e-300, 1e-20, 1.0, 1e30, 1e300}) {
      for (const NoiseCase& c : all_filters(2, sigma)) {
        const Volume<float> result = denoised(v, c.options);
        for (const float out : result.voxels.span()) {
          ASSERT_TRUE(std::isfinite(out)) << c.name << " range " << top << " sigma " << sigma;
          ASSERT_LE(std::abs(out), top * 1.000002F) << c.name << " range " << top << " sigma " << sigma;
        }
      }
    }
  }
  set_thread_count(0);
}

/// Centre voxel of a 3x3x3 volume whose only other value is its x neighbour; the weight follows from the result.
double weight_seen(RangeWeight range, double difference, double sigma) {
  const Volume<float> v = make_volume({3, 1, 1}, [&](auto x, auto, auto) { return x == 2 ? difference : 0.0; });
  const DenoiseOptions options{DenoiseMethod::kBilateral, range, 3, 1, sigma};
  const double out = denoised(v, options).at(1, 0, 0);  // out = w d / (3 + w): centre and left count 2 + 1
  return 3.0 * out / (difference - out);
}

TEST(Denoise, TukeyIsRootOfEAtSigmaAndNothingAtItsEnd) {
  const double sigma = 0.37, end = sigma / std::sqrt(1.0 - std::exp(-0.25));
  EXPECT_NEAR(kTukeyScale, 1.0 / std::sqrt(1.0 - std::exp(-0.25)), 1e-15);
  EXPECT_NEAR(weight_seen(RangeWeight::kTukey, sigma, sigma), std::exp(-0.5), 1e-6);
  EXPECT_NEAR(weight_seen(RangeWeight::kGauss, sigma, sigma), std::exp(-0.5), 1e-6);
  EXPECT_NEAR(weight_seen(RangeWeight::kTukey, 0.999 * end, sigma), std::pow(1.0 - 0.999 * 0.999, 2), 1e-6);
  EXPECT_EQ(weight_seen(RangeWeight::kTukey, 1.0001 * end, sigma), 0.0);
  EXPECT_EQ(weight_seen(RangeWeight::kTukey, -50.0 * end, sigma), 0.0);
  EXPECT_NEAR(weight_seen(RangeWeight::kGauss, 2.0 * sigma, sigma), std::exp(-2.0), 1e-6);
}

TEST(Denoise, MedianRemovesSaltAndKeepsThePlaneStep) {
  std::mt19937_64 random(4);
  const auto clean = [](std::int64_t x) { return x < 15 ? 1.0 : 3.0; };
  const Volume<float> v =
      make_volume({30, 20, 20}, [&](auto x, auto, auto) { return random() % 25 == 0 ? 100.0 : clean(x); });
  const Volume<float> out = denoised(v, {DenoiseMethod::kMedian, RangeWeight::kTukey, 3, 1, 0.0});
  for (std::int64_t z = 0; z < 20; ++z)
    for (std::int64_t y = 0; y < 20; ++y)
      for (std::int64_t x = 0; x < 30; ++x) ASSERT_LE(out.at(x, y, z), 3.0F);
  std::int64_t wrong = 0;
  for (std::int64_t z = 0; z < 20; ++z)
    for (std::int64_t y = 0; y < 20; ++y)
      for (std::int64_t x = 0; x < 30; ++x) wrong += out.at(x, y, z) != static_cast<float>(clean(x));
  EXPECT_LT(wrong, 12);  // salt at the step may move the median by one class: 18 dark of 27, at least 5 of them hit
}

TEST(Denoise, MedianOfNegativeValuesAndZerosIsOneOfThem) {
  const Volume<float> v = make_volume(
      {9, 9, 9}, [](auto x, auto y, auto z) { return static_cast<double>((x * 5 + y * 11 + z * 17) % 23) - 11.0; });
  for (const int window : {3, 5, 7}) {
    const DenoiseOptions options{DenoiseMethod::kMedian, RangeWeight::kTukey, window, 1, 0.0};
    const Volume<double> expected = oracle::denoise_once(v, options);
    const Volume<float> out = denoised(v, options);
    for (std::int64_t i = 0; i < v.dims.count(); ++i) ASSERT_EQ(out.voxels[i], expected.voxels[i]);
  }
}

TEST(Denoise, JointBilateralKeepsAStepThatGaussBlurs) {
  oracle::Noise noise(5);
  const auto clean = [](std::int64_t x) { return x < 24 ? 0.0 : 1.0; };
  const Volume<float> v = make_volume({48, 32, 32}, [&](auto x, auto, auto) { return clean(x) + 0.05 * noise(); });
  const auto step_error = [&](DenoiseMethod method) {
    const Volume<float> out = denoised(v, {method, RangeWeight::kTukey, 3, 2, 0.05});
    double squares = 0.0;
    for (std::int64_t z = 2; z < 30; ++z)
      for (std::int64_t y = 2; y < 30; ++y)
        for (std::int64_t x = 22; x < 26; ++x) squares += std::pow(out.at(x, y, z) - clean(x), 2);
    return std::sqrt(squares / (28 * 28 * 4));
  };
  const double joint = step_error(DenoiseMethod::kJointBilateral), gauss = step_error(DenoiseMethod::kGauss);
  EXPECT_LT(joint, 0.05);
  EXPECT_GT(gauss, 0.2);
}

// Uniform clay and air, so that nothing but noise is measured. On scans with structure the histogram says about 1 to
// 2 dB less after each step.
TEST(Denoise, SignalToNoiseRisesByAtLeastTheFiguresOfThePaper) {
  const Dims raw{160, 96, 96};
  const double sigma = std::pow(10.0, -17.0 / 20.0);
  const Volume<float> noise = oracle::correlated_noise(raw, sigma, 6);
  const Volume<float> scan =
      make_volume(raw, [&](auto x, auto y, auto z) { return (x < 80 ? 0.0 : 1.0) + noise.at(x, y, z); });
  const auto clay = [](const Volume<float>& v) { return oracle::moments(v, v.dims.x / 2 + 6, v.dims.x - 6, 6); };
  const auto snr_db = [&](const Volume<float>& v) {
    const oracle::Moments low = oracle::moments(v, 6, v.dims.x / 2 - 6, 6), high = clay(v);
    return 20.0 * std::log10((high.mean - low.mean) / high.sigma);
  };
  VolumeSource source(scan);
  HalfResolutionSource half(source);
  const Volume<float> low_passed = read_all(half, 16).value();
  const Volume<float> once = denoised(low_passed, {.iterations = 1, .sigma = clay(low_passed).sigma});
  const Volume<float> twice = denoised(once, {.iterations = 1, .sigma = clay(once).sigma});
  // Correlation of the noise at lag 1 per axis is 8/18, at lag 2 it is 1/18: [1 2 1]/4 leaves this much variance.
  const double left = (6.0 + 8.0 * 8.0 / 18.0 + 2.0 / 18.0) / 16.0;
  EXPECT_NEAR(snr_db(scan), 17.0, 0.1);
  EXPECT_NEAR(snr_db(low_passed), 17.0 - 30.0 * std::log10(left), 0.2);
  EXPECT_GT(snr_db(once), 29.7);
  EXPECT_GT(snr_db(twice), 31.9);
}

TEST(Denoise, OptionsThatMakeNoSenseAreRefused) {
  const Volume<float> v = make_volume({2, 2, 2}, [](auto, auto, auto) { return 0.0; });
  VolumeSource source(v);
  for (const DenoiseOptions& options :
       {DenoiseOptions{.window = 4, .sigma = 1.0}, DenoiseOptions{.iterations = -1, .sigma = 1.0}, DenoiseOptions{},
        DenoiseOptions{.sigma = -1.0}, DenoiseOptions{.sigma = std::nan("")}}) {
    const auto filter = make_denoised(source, options);
    ASSERT_FALSE(filter);
    EXPECT_EQ(filter.error().kind, ErrorKind::kUsage);
  }
  EXPECT_TRUE(make_denoised(source, {.method = DenoiseMethod::kMedian}));
  EXPECT_TRUE(make_denoised(source, {.iterations = 0}));
}

TEST(Denoise, ItCanBeStopped) {
  Volume<float> v = make_volume({40, 40, 40}, [](auto, auto, auto) { return 0.0; });
  SilentProgress progress;
  progress.cancel();
  const auto result = denoise_in_place(v, {.sigma = 1.0}, progress);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
