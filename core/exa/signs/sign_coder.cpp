#include "core/exa/signs/sign_coder.h"

#include <algorithm>

namespace dubsar {
namespace {
constexpr std::array<std::size_t, 8> kPhaseIndex = [] {
  std::array<std::size_t, 8> index{};
  for (std::size_t p = 0; p < kSignPhases.size(); ++p) index[static_cast<std::size_t>(kSignPhases[p])] = p;
  return index;
}();

/// How likely a cell of equal corners hides a surface, by the number of neighbours whose corners differ, first as if
/// kSeen cells had been seen; counted on a phantom of 23 dB.
constexpr std::array<std::uint32_t, 7> kHidden{16, 200, 1500, 2600, 5000, 6000, 8000};
constexpr std::array<std::uint32_t, 7> kHiddenBesideHidden{4000, 12000, 20000, 22000, 24000, 26000, 28000};
constexpr int kSeen = 20;
}  // namespace

SignStatistics::SignStatistics(std::size_t model, bool coarse) : model_(&SignModel::instance(model)), coarse_(coarse) {
  for (std::size_t context = 0; context < flags_.size(); ++context)
    flags_[context] = AdaptiveBit((context / 14 % 2 ? kHiddenBesideHidden : kHidden)[context % 7], kSeen);
}

void SignStatistics::begin(const SignLattice& lattice, int level, int phase) noexcept {
  const std::size_t index = kPhaseIndex[static_cast<std::size_t>(phase)];
  const std::size_t level_class = coarse_ ? 2 : static_cast<std::size_t>(std::min(level, 2));
  refiner_ = &refiners_[level_class * 7 + index];
  place_ = model_->place(lattice, index, level_class);
}

}  // namespace dubsar
