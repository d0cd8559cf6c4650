#pragma once
// From logits to probabilities, and probabilities that learn (docs/exa.md, "Probabilities").

#include <array>
#include <cstdint>

namespace dubsar {

/// Probability of 65536 at logits -8, -7.5, .. 8, kept 16 away from both ends.
inline constexpr std::array<std::int32_t, 33> kLogistic{22,    36,    60,    98,    162,   267,   439,   720,   1179,
                                                        1921,  3108,  4971,  7812,  11955, 17625, 24743, 32768, 40793,
                                                        47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097,
                                                        65269, 65374, 65438, 65476, 65500, 65514};

/// `logit` in 1 / 256, -2048..2047; linear between the 33 places.
constexpr std::uint32_t probability_of(int logit) noexcept {
  const int at = logit + 2048, i = at >> 7, f = at & 127;
  const auto k = static_cast<std::size_t>(i);
  return static_cast<std::uint32_t>((kLogistic[k] * (128 - f) + kLogistic[k + 1] * f) >> 7);
}

/// A curve over the logit that starts as the logistic function and moves to what is seen.
class Refiner {
 public:
  std::uint32_t predict(int logit) noexcept {
    const int at = logit + 2048, f = at & 127;
    const auto k = static_cast<std::size_t>(at >> 7);
    nearest_ = f < 64 ? k : k + 1;
    const int own = (curve_[k] * (128 - f) + curve_[k + 1] * f) >> 7;
    return static_cast<std::uint32_t>((own + static_cast<int>(probability_of(logit))) >> 1);
  }
  void learn(bool bit) noexcept { curve_[nearest_] += ((bit ? 65520 : 16) - curve_[nearest_]) >> kRate; }

 private:
  static constexpr int kRate = 6;
  std::array<std::int32_t, 33> curve_ = kLogistic;
  std::size_t nearest_ = 0;
};

}  // namespace dubsar
