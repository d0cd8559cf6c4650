#pragma once
// The seal as nobody has seen it: all its impressions as one.

#include <vector>

#include "core/seals/seal_turn.h"

namespace dubsar {

struct SealAverage {
  SealImpression relief;           ///< mm over the ground as in the impressions (figures stand out); shown: 0 where no
                                   ///< impression shows anything
  std::vector<float> seen_by;      ///< of each place: how many impressions show it, a turn apart counted as another
  SealPlacing placing;             ///< after the last round
  std::vector<std::uint8_t> used;  ///< of each impression: it was laid on the others
  glm::dvec2 least_mm{0.0};        ///< of the raster, in the frame of the first impression
};

struct AverageOptions {
  double turn_mm = 0.0;   ///< 0: found where impressions tell it; less than 0: not folded
  std::size_t first = 0;  ///< whose raster is the frame: the one that was laid flat with the least distortion
};

/// Impressions of one step. Each place is the mean of what lies there, folded by the turn, by the probability that each
/// shows it (mean_of_views()). Each impression is then laid anew on the mean of the others (refined()). Deterministic,
/// the same for any number of threads. kUsage-like conditions are the caller's: there is at least one impression.
SealAverage average_seal(const std::vector<SealImpression>& impressions, const AverageOptions& options = {});

}  // namespace dubsar
