#pragma once
// Probabilities of the signs and flags of one brick: the fixed network, refined by what was seen in the brick so far.

#include <array>
#include <cstdint>

#include "core/exa/probability.h"
#include "core/exa/range_coder.h"
#include "core/exa/sign_model.h"

namespace dubsar {

class SignStatistics {
 public:
  /// `model`: 0..kSignModels - 1; `coarse`: the brick is of the volume of every eighth point.
  SignStatistics(std::size_t model, bool coarse);

  AdaptiveBit& flag(int context) noexcept { return flags_[static_cast<std::size_t>(context)]; }

  /// Probability that a point is inside; learn() with the truth must follow.
  std::uint32_t predict(const SignLattice& lattice, int level, int phase, int x, int y, int z) noexcept;
  void learn(bool inside) noexcept { refiners_[refiner_].learn(inside); }

 private:
  const SignModel* model_;
  bool coarse_ = false;
  std::array<Refiner, 21> refiners_;
  std::size_t refiner_ = 0;
  std::array<AdaptiveBit, kFlagContexts> flags_;
};

}  // namespace dubsar
