#pragma once
// Several guesses at the probability of a bit, mixed by weights that learn which of them are right (Mahoney 2005, the
// mixer of PAQ). In integers (docs/exa.md, "Labels").

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/exa/coding/probability.h"
#include "core/exa/coding/range_coder.h"

namespace dubsar {

/// The least logit in 1 / 256 whose probability is not below `p` of 65536: by p / 16.
inline int logit_of(std::uint32_t p) noexcept {
  static const std::array<std::int16_t, 4096> kLogits = [] {
    std::array<std::int16_t, 4096> logits{};
    int z = -2047;
    for (std::size_t i = 0; i < logits.size(); ++i) {
      while (z < 2047 && probability_of(z) < 16 * i + 8) ++z;
      logits[i] = static_cast<std::int16_t>(z);
    }
    return logits;
  }();
  return kLogits[p >> 4];
}

/// `Inputs` guesses, `Sets` sets of weights to choose from.
template <std::size_t Inputs, std::size_t Sets>
class BitMixer {
 public:
  BitMixer() {
    for (auto& set : weights_) set.fill(kFirstWeight);
  }
  std::uint32_t predict(std::size_t set, const std::array<std::uint32_t, Inputs>& p) noexcept {
    now_ = &weights_[set];
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < Inputs; ++i) {
      logits_[i] = logit_of(p[i]);
      sum += std::int64_t{(*now_)[i]} * logits_[i];
    }
    const auto logit = static_cast<int>(std::clamp<std::int64_t>(sum >> 16, -2047, 2047));
    p_ = std::clamp<std::uint32_t>(probability_of(logit), kLeastMixed, kProbabilityOne - kLeastMixed);
    return p_;
  }
  /// Of the bit that was predicted last.
  void learn(bool bit) noexcept {
    const int error = (((bit ? 65535 : 0) - static_cast<int>(p_)) >> 4) * kMixRate;
    for (std::size_t i = 0; i < Inputs; ++i) (*now_)[i] += (logits_[i] * error + 0x8000) >> 16;
  }

 private:
  static constexpr std::int32_t kFirstWeight = 65536 * 2 / 5;  // a little more than the mean of the six of labels
  static constexpr int kMixRate = 7;                           // Mahoney's
  static constexpr std::uint32_t kLeastMixed = 32;
  std::array<std::array<std::int32_t, Inputs>, Sets> weights_;
  std::array<std::int32_t, Inputs>* now_ = &weights_[0];
  std::array<int, Inputs> logits_{};
  std::uint32_t p_ = kProbabilityOne / 2;
};

}  // namespace dubsar
