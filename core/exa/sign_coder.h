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

  /// Points of this phase follow.
  void begin(const SignLattice& lattice, int level, int phase) noexcept;
  /// Probability that a point is inside; learn() with the truth must follow.
  std::uint32_t predict(int x, int y, int z) noexcept;
  void learn(bool inside) noexcept { refiner_->learn(inside); }

 private:
  const SignModel* model_;
  bool coarse_ = false;
  std::array<Refiner, 21> refiners_;
  Refiner* refiner_ = nullptr;
  SignModel::Place place_;
  std::array<AdaptiveBit, kFlagContexts> flags_;
};

}  // namespace dubsar
