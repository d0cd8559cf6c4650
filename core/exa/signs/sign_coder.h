#pragma once
// Probabilities of the signs and flags of one brick: the fixed network, refined by what was seen in the brick so far.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/exa/coding/probability.h"
#include "core/exa/coding/range_coder.h"
#include "core/exa/signs/sign_model.h"

namespace dubsar {

class SignStatistics {
 public:
  /// `model`: 0..kSignModels - 1; `coarse`: the brick is of the volume of every eighth point.
  SignStatistics(std::size_t model, bool coarse);

  AdaptiveBit& flag(int context) noexcept { return flags_[static_cast<std::size_t>(context)]; }

  /// Points of this phase follow.
  void begin(const SignLattice& lattice, int level, int phase) noexcept;
  /// Sets the signs of points of a row, rising: code(x, p) codes one that is inside with probability p.
  template <class Code>
  void walk(SignLattice& lattice, int y, int z, std::span<const std::uint8_t> xs, const Code& code) {
    if (lattice.mirrors_itself(y, z)) {
      for (const int x : xs)
        if (coded(x, SignModel::logit(place_, x, y, z), code)) lattice.set(x, y, z);
      return;
    }
    std::array<SignLogits, 130> logits;
    SignModel::row_logits(place_, y, z, xs, logits.data());
    std::array<std::uint64_t, 3> found{};
    std::size_t before = 0;
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const bool inside = coded(xs[i], logits[i][before], code);
      found[(xs[i] + 8u) >> 6] |= std::uint64_t{inside} << ((xs[i] + 8u) & 63);
      before = inside ? 1 : 0;
    }
    lattice.merge(y, z, found);
  }

 private:
  template <class Code>
  bool coded(int x, int logit, const Code& code) {
    const std::uint32_t p = refiner_->predict(logit);
    const bool inside = code(x, std::clamp<std::uint32_t>(p, 16, kProbabilityOne - 16));
    refiner_->learn(inside);
    return inside;
  }

  const SignModel* model_;
  bool coarse_ = false;
  std::array<Refiner, 21> refiners_;
  Refiner* refiner_ = nullptr;
  SignModel::Place place_;
  std::array<AdaptiveBit, kFlagContexts> flags_;
};

}  // namespace dubsar
