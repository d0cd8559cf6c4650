#pragma once
// Several impressions of one seal: which belong together, how they lie on each other, and how long one turn of it is.

#include <vector>

#include "core/seals/seal_match.h"

namespace dubsar {

struct SealPlacing {
  std::vector<PlacedOn> seal_from_band;  ///< of each impression, mm; the frame is that of the impression `first`
  std::vector<double> likeness;          ///< to what it was laid on, in deviations; 0: laid on nothing
  std::size_t first = 0;
  double turn_mm = 0.0;    ///< the seal's circumference; 0: not found, or not said
  double turn_sure = 0.0;  ///< likeness of what lies a turn apart, in deviations; 0: said by a person
};

/// From the `first` impression on the others are laid on it or on one that is, the most alike first (a
/// tree of most likeness; R. Prim, 1957). Below 4.5 deviations it is left out: of unlike ones the best of all shifts
/// reaches 3.5. The turn is the length at which impressions, each moved by it against the others and against itself,
/// are most alike beyond chance (15 to 90 mm, cylinder seals are 20 to 80 round), from 3 deviations on. `turn_mm` more
/// than 0: said.
SealPlacing place_impressions(const std::vector<SealImpression>& impressions, std::size_t first, double turn_mm);

}  // namespace dubsar
