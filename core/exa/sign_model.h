#pragma once
// How likely is a point inside, given the signs around it? A small network per phase with fixed integer weights
// (docs/exa.md, "Signs"). They were fitted by gradient descent on the logarithmic loss: scan on phantoms of 23 to 33 dB
// and two CT volumes, smooth on spheres; test surfaces were others.

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/exa/sign_brick.h"

namespace dubsar {

struct SignTap {
  int x = 0, y = 0, z = 0;
};

/// The neighbours that a point of a phase can know: at most kSignReach2 away (squared), in rising z, y, x; points of
/// even coordinates, of earlier phases, and those of its own phase that come before it.
inline constexpr int kSignReach2 = 11;
std::vector<SignTap> sign_taps(int phase);

inline constexpr std::size_t kSignModels = 2;
inline constexpr int kSignUnits = 16;  ///< hidden units

/// Weights of one phase: units x taps; a hidden unit is clamp(sum of +-weight + bias, 0, 1023), the logit in 1 / 256 is
/// (sum of weight x unit) / 8 rounded down + bias of the level.
struct SignWeights {
  std::vector<std::int8_t> in;  ///< [tap][unit]
  std::array<std::int16_t, kSignUnits> in_bias{}, out{};
  std::array<std::int16_t, 3> out_bias{};  ///< by level_class
};

class SignModel {
 public:
  /// Built on first use from the tables of weights; thread-safe. `which`: 0 for surfaces with the noise of a scan, 1
  /// for smooth ones.
  static const SignModel& instance(std::size_t which);
  explicit SignModel(const std::array<SignWeights, 7>& weights);

  struct alignas(32) Sums : std::array<std::int16_t, kSignUnits> {};
  struct Row {
    int y = 0, z = 0;
    std::array<Sums, 128> sums;  ///< by the signs at x - 3 .. x + 3
  };
  struct Phase {
    std::vector<Row> rows;  ///< that of the point itself last: its signs are known last
    Sums bias{}, out{};
    std::array<std::int16_t, 3> out_bias{};
  };
  /// A phase on a lattice.
  struct Place {
    static constexpr std::size_t kRows = 37;  ///< rows at most sqrt(11) away
    const SignLattice* lattice = nullptr;
    const Phase* phase = nullptr;
    int out_bias = 0;
    std::array<std::ptrdiff_t, kRows> steps{};  ///< bytes from the row of a point to those of phase->rows
  };
  /// `phase_index`: place in kSignPhases. The lattice must outlive it and not be exchanged.
  Place place(const SignLattice& lattice, std::size_t phase_index, std::size_t level_class) const;
  /// In 1 / 256, clamped to +-2047.
  static int logit(const Place& place, int x, int y, int z) noexcept;

 private:
  std::array<Phase, 7> phases_;
};

}  // namespace dubsar
