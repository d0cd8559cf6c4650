#include "tests/bench/training/sign_trainer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/exa/signs/sign_brick.h"

namespace dubsar {
namespace {
constexpr std::size_t kBatch = 128;
constexpr float kInScale = 32.0f, kOutScale = 64.0f, kLogitScale = 256.0f;  // stored integers of 1
constexpr float kMostUnit = 1023.0f / kInScale, kMostWeight = 3.9f;         // 127 / 32

bool tap(const SignSample& sample, std::size_t t) { return (sample.taps[t / 64] >> t % 64 & 1) != 0; }

/// All weights of one phase in a row: [tap][unit], biases, out weights, three biases of the levels.
template <std::size_t kUnits>
class PhaseTrainer {
 public:
  PhaseTrainer(std::size_t taps, unsigned seed)
      : taps_(taps),
        weights_((taps + 2) * kUnits + 3),
        gradient_(weights_.size()),
        mean_(weights_.size(), 0.0f),
        square_(weights_.size(), 0.0f),
        random_(seed) {
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; i < taps * kUnits; ++i) weights_[i] = normal(random_) / std::sqrt(static_cast<float>(taps));
    for (std::size_t u = 0; u < kUnits; ++u) weights_[(taps + 1) * kUnits + u] = 0.5f * normal(random_);
  }

  void train(const std::vector<SignSample>& samples, int epochs, double rate) {
    std::vector<std::uint32_t> order(samples.size());
    std::iota(order.begin(), order.end(), 0u);
    const double steps = static_cast<double>(epochs) * static_cast<double>((order.size() + kBatch - 1) / kBatch);
    for (int epoch = 0; epoch < epochs; ++epoch) {
      std::shuffle(order.begin(), order.end(), random_);
      for (std::size_t first = 0; first < order.size(); first += kBatch) {
        const std::size_t end = std::min(first + kBatch, order.size());
        std::fill(gradient_.begin(), gradient_.end(), 0.0f);
        for (std::size_t i = first; i < end; ++i) add_gradient(samples[order[i]]);
        step(static_cast<float>(end - first), 0.5 * rate * (1.0 + std::cos(3.141592653589793 * done_ / steps)) + 1e-5);
      }
    }
  }

  SignWeights rounded() const {
    const auto whole = [](float w, float scale) { return static_cast<std::int16_t>(std::lround(w * scale)); };
    SignWeights stored;
    stored.in.resize(taps_ * kSignUnits);
    for (std::size_t t = 0; t < taps_; ++t)
      for (std::size_t u = 0; u < kUnits; ++u)
        stored.in[t * kSignUnits + u] = static_cast<std::int8_t>(whole(weights_[t * kUnits + u], kInScale));
    for (std::size_t u = 0; u < kUnits; ++u) {
      stored.in_bias[u] = whole(weights_[taps_ * kUnits + u], kInScale);
      stored.out[u] = whole(weights_[(taps_ + 1) * kUnits + u], kOutScale);
    }
    for (std::size_t l = 0; l < 3; ++l) stored.out_bias[l] = whole(weights_[(taps_ + 2) * kUnits + l], kLogitScale);
    return stored;
  }

 private:
  void add_gradient(const SignSample& sample) {
    std::array<float, kUnits> unit, back;
    const float *bias = weights_.data() + taps_ * kUnits, *out = bias + kUnits, *level = out + kUnits;
    for (std::size_t u = 0; u < kUnits; ++u) unit[u] = bias[u];
    for (std::size_t t = 0; t < taps_; ++t) {
      const float sign = tap(sample, t) ? 1.0f : -1.0f;
      const float* row = weights_.data() + t * kUnits;
      for (std::size_t u = 0; u < kUnits; ++u) unit[u] += sign * row[u];
    }
    float logit = level[sample.level_class];
    for (std::size_t u = 0; u < kUnits; ++u) {
      unit[u] = std::min(std::max(unit[u], 0.0f), kMostUnit);
      logit += unit[u] * out[u];
    }
    const float off = 1.0f / (1.0f + std::exp(-logit)) - (sample.inside ? 1.0f : 0.0f);
    float *g_bias = gradient_.data() + taps_ * kUnits, *g_out = g_bias + kUnits;
    for (std::size_t u = 0; u < kUnits; ++u) {
      g_out[u] += off * unit[u];
      back[u] = unit[u] > 0.0f && unit[u] < kMostUnit ? off * out[u] : 0.0f;
      g_bias[u] += back[u];
    }
    g_out[kUnits + sample.level_class] += off;
    for (std::size_t t = 0; t < taps_; ++t) {
      const float sign = tap(sample, t) ? 1.0f : -1.0f;
      float* row = gradient_.data() + t * kUnits;
      for (std::size_t u = 0; u < kUnits; ++u) row[u] += sign * back[u];
    }
  }

  void step(float count, double rate) {
    ++done_;
    decay_mean_ *= 0.9;
    decay_square_ *= 0.999;
    const auto mean_scale = static_cast<float>(rate / (1.0 - decay_mean_)),
               square_scale = static_cast<float>(1.0 / (1.0 - decay_square_));
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const float g = gradient_[i] / count;
      mean_[i] = 0.9f * mean_[i] + 0.1f * g;
      square_[i] = 0.999f * square_[i] + 0.001f * g * g;
      weights_[i] -= mean_scale * mean_[i] / (std::sqrt(square_[i] * square_scale) + 1e-8f);
    }
    for (std::size_t i = 0; i < taps_ * kUnits; ++i) weights_[i] = std::clamp(weights_[i], -kMostWeight, kMostWeight);
  }

  std::size_t taps_;
  std::vector<float> weights_, gradient_, mean_, square_;
  std::mt19937 random_;
  double done_ = 0.0, decay_mean_ = 1.0, decay_square_ = 1.0;
};

template <std::size_t kUnits>
SignWeights trained_phase(const std::vector<SignSample>& samples, std::size_t phase, const SignTraining& training) {
  PhaseTrainer<kUnits> trainer(sign_taps(kSignPhases[phase]).size(), training.seed + static_cast<unsigned>(phase));
  trainer.train(samples, training.epochs, training.rate);
  return trainer.rounded();
}
}  // namespace

std::array<SignWeights, 7> train_signs(const SignSamples& samples, const SignTraining& training) {
  DUBSAR_CHECK(training.units == 16 || training.units == 64);
  std::array<SignWeights, 7> weights;
  parallel_for(7, 1, [&](std::int64_t i) {
    const std::size_t phase = 6 - static_cast<std::size_t>(i);  // those with most taps first
    weights[phase] = training.units == 16 ? trained_phase<16>(samples[phase], phase, training)
                                          : trained_phase<64>(samples[phase], phase, training);
  });
  return weights;
}

double sign_bits(const SignSamples& samples, const std::array<SignWeights, 7>& weights, std::size_t units) {
  double bits = 0.0;
  for (std::size_t phase = 0; phase < 7; ++phase) {
    const SignWeights& w = weights[phase];
    const std::size_t taps = sign_taps(kSignPhases[phase]).size();
    for (const SignSample& sample : samples[phase]) {
      int logit = 0;
      for (std::size_t u = 0; u < units; ++u) {
        int unit = w.in_bias[u];
        for (std::size_t t = 0; t < taps; ++t)
          unit += tap(sample, t) ? w.in[t * kSignUnits + u] : -w.in[t * kSignUnits + u];
        logit += std::clamp(unit, 0, 1023) * w.out[u];
      }
      logit = std::clamp((logit >> 3) + w.out_bias[sample.level_class], -2047, 2047);
      bits += std::log2(1.0 + std::exp((sample.inside ? -1.0 : 1.0) * logit / double{kLogitScale}));
    }
  }
  return bits;
}

std::string sign_weights_text(const std::array<SignWeights, 7>& weights, std::size_t units, std::string_view name) {
  std::vector<int> numbers;
  for (const SignWeights& w : weights) {
    for (std::size_t t = 0; t < w.in.size() / kSignUnits; ++t)
      for (std::size_t u = 0; u < units; ++u) numbers.push_back(w.in[t * kSignUnits + u]);
    numbers.insert(numbers.end(), w.in_bias.begin(), w.in_bias.begin() + static_cast<std::ptrdiff_t>(units));
    numbers.insert(numbers.end(), w.out.begin(), w.out.begin() + static_cast<std::ptrdiff_t>(units));
    numbers.insert(numbers.end(), w.out_bias.begin(), w.out_bias.end());
  }
  std::string text = fmt::format(
      "// Written by train_signs: for each phase the weights [tap][unit], the biases of the units, their out weights,\n"
      "// the biases of the levels.\n// clang-format off\nconst std::int16_t kSignWeights{}[] = {{\n",
      name);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += fmt::format("{},{}", numbers[i], i % 40 == 39 || i + 1 == numbers.size() ? "\n" : "");
  return text + "};\n// clang-format on\n";
}

}  // namespace dubsar
