#pragma once
// How likely is a point inside, given the signs around it? A small network per phase with fixed integer weights
// (docs/exa.md, "Signs"). They were fitted by gradient descent on the logarithmic loss (training/): scan on phantoms of
// 20 to 36 dB and CT volumes, smooth on spheres; test surfaces were others.

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/exa/signs/sign_brick.h"

namespace dubsar {

struct SignTap {
  int x = 0, y = 0, z = 0;
};

/// The neighbours that a point of a phase can know: at most kSignReach2 away (squared), in rising z, y, x; points of
/// even coordinates, of earlier phases, and those of its own phase that come before it.
inline constexpr int kSignReach2 = 11;
std::vector<SignTap> sign_taps(int phase);

/// Models: 0 scan and 1 smooth of 16 units, as in version 3; 2 scan of 64 units.
inline constexpr std::size_t kSignModels = 3;
inline constexpr std::array<std::size_t, 2> kSignModelsTried{2, 1};  ///< by the encoder: 0 is worse than 2 everywhere
inline constexpr int kSignUnits = 64;  ///< hidden units; those that a model has not got are 0

/// Weights of one phase: units x taps; a hidden unit is clamp(sum of +-weight + bias, 0, 1023), the logit in 1 / 256 is
/// (sum of weight x unit) / 8 rounded down + bias of the level.
struct SignWeights {
  std::vector<std::int8_t> in;  ///< [tap][unit]
  std::array<std::int16_t, kSignUnits> in_bias{}, out{};
  std::array<std::int16_t, 3> out_bias{};  ///< by level_class
};

/// Logits of a point, if the one two before it is outside, and if it is inside.
using SignLogits = std::array<std::int16_t, 2>;

class SignModel {
 public:
  /// The network of a model, built on first use from the tables of weights; thread-safe.
  static const SignModel& instance(std::size_t model);
  /// Its weights as they are stored.
  static std::array<SignWeights, 7> stored_weights(std::size_t model);
  /// `units`: 16 or 64; the weights of further ones are not looked at.
  SignModel(const std::array<SignWeights, 7>& weights, std::size_t units);

  struct Row {
    int y = 0, z = 0;
    std::array<std::uint16_t, 128> at{};  ///< which of the phase's sums, by the signs at x - 3 .. x + 3
  };
  struct alignas(64) Line : std::array<std::int16_t, 32> {};
  struct Phase {
    std::vector<Row> rows;   ///< that of the point itself last: its signs are known last
    std::vector<Line> sums;  ///< of a row's weights, with the units of the model for each set of its taps
    std::array<Line, 2> bias{}, out{};
    std::array<std::int16_t, 3> out_bias{};
  };
  /// A phase on a lattice.
  struct Place {
    static constexpr std::size_t kRows = 37;  ///< rows at most sqrt(11) away
    const SignLattice* lattice = nullptr;
    const Phase* phase = nullptr;
    std::size_t units = 0;
    int out_bias = 0;
    /// For this processor: sums of some points of a row; both of each the same, where the point before is known.
    void (*weigh)(const Place&, const unsigned char* row, std::span<const std::uint8_t> xs,
                  std::int32_t* sums) = nullptr;
    std::array<std::ptrdiff_t, kRows> steps{};  ///< bytes from the row of a point to those of phase->rows
  };
  /// `phase_index`: place in kSignPhases. The lattice must outlive it and not be exchanged.
  Place place(const SignLattice& lattice, std::size_t phase_index, std::size_t level_class) const;
  /// In 1 / 256, clamped to +-2047.
  static int logit(const Place& place, int x, int y, int z) noexcept;
  /// Of rising points of a row, none of which is set yet; the first of a pair is the only one that counts where x - 2
  /// is not among them, and the second is the same then.
  static void row_logits(const Place& place, int y, int z, std::span<const std::uint8_t> xs, SignLogits* out) noexcept;

 private:
  std::size_t units_;
  std::array<Phase, 7> phases_;
};

}  // namespace dubsar
