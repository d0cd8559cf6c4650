#pragma once
// Where does an edge cross the surface, given its surroundings? A small network per axis with fixed integer weights
// gives mean and spread of a logistic distribution (docs/exa.md, "Offsets"). Fitted as those of the signs, scan on
// crossings of 4 bits, smooth on settled ones of 4 and 5 bits.

#include <array>
#include <cstdint>

#include "core/exa/offset_window.h"
#include "core/exa/probability.h"

namespace dubsar {

inline constexpr std::size_t kOffsetModels = 2;  ///< 0: crossings of a scan, 1: of a smoothed surface
inline constexpr std::size_t kOffsetUnits = 24;
inline constexpr int kModelledBits = 6;  ///< of an offset; the lower ones are noise

/// Logit steps (1 / 256) per 1 / 1024 grid step, times 256: 2^16 / (16 * 2^(s / 4)) for spread s, rounded.
inline constexpr std::array<std::int32_t, 32> kSteepness{4096, 3444, 2896, 2435, 2048, 1722, 1448, 1218, 1024, 861, 724,
                                                         609,  512,  431,  362,  304,  256,  215,  181,  152,  128, 108,
                                                         91,   76,   64,   54,   45,   38,   32,   27,   23,   19};

/// Probabilities of the 2^bits symbols of one edge, as intervals of 65536.
class OffsetDistribution {
 public:
  OffsetDistribution(int mean, int spread, int bits) noexcept
      : mean_(mean), steepness_(kSteepness[static_cast<std::size_t>(spread)]), bits_(bits) {}
  /// Start of the interval of symbol k, 0..2^bits; rises by 32 at least with each k.
  std::uint32_t start(std::uint32_t k) const noexcept {
    if (k == 0) return 0;
    const std::uint32_t symbols = 1u << bits_;
    if (k == symbols) return 1u << 16;
    const std::int64_t distance = (std::int64_t{k} << (10 - bits_)) - 512 - mean_;
    const std::int64_t logit = distance * steepness_ >> 8;
    const std::uint32_t below = probability_of(static_cast<int>(logit < -2048 ? -2048 : logit > 2047 ? 2047 : logit));
    return (below * (65536 - 32 * symbols) >> 16) + 32 * k;
  }
  /// The symbol whose interval holds `place`, 0..65535.
  std::uint32_t find(std::uint32_t place) const noexcept {
    std::uint32_t low = 0;
    for (std::uint32_t step = 1u << (bits_ - 1); step != 0; step >>= 1)
      if (start(low + step) <= place) low += step;
    return low;
  }

 private:
  std::int64_t mean_;
  std::int64_t steepness_;
  int bits_;
};

class OffsetModel {
 public:
  static const OffsetModel& instance(std::size_t which);
  explicit OffsetModel(const std::int16_t* weights);
  OffsetDistribution predict(int axis, const OffsetInputs& inputs, int bits) const noexcept;

 private:
  struct Axis {
    std::array<OffsetInputs, kOffsetUnits> in{};
    std::array<std::int16_t, kOffsetUnits> bias{};
    std::array<std::array<std::int16_t, kOffsetUnits>, 2> out{};
    std::array<std::int16_t, 2> out_bias{};
  };
  std::array<Axis, 3> axes_;
};

}  // namespace dubsar
