#pragma once
// Several impressions of one seal: which belong together, how they lie on each other, and how long one turn of it is.

#include <vector>

#include "core/seals/seal_match.h"

namespace dubsar {

struct SealPlacing {
  std::vector<PlacedOn> seal_from_band;  ///< of each impression, mm; the frame is that of the impression `first`
  std::vector<double> likeness;          ///< to the most alike that lies there, in deviations; 0: laid on nothing
  std::size_t first = 0;
  double turn_mm = 0.0;    ///< the seal's circumference; 0: not found, or not said
  double turn_sure = 0.0;  ///< logarithm of how much more likely it is than none; 0: said by a person
};

/// From the `first` impression on the others are laid on those that lie there, the most alike first (a tree of most
/// likeness; R. Prim, 1957). Each goes where all pairs together say: of all places where it is alike to one of them,
/// the one that is most likely by its likeness to every one, a turn to either side counted as the same place. Below
/// 4.5 deviations to the most alike it is left out: of unlike ones the best of all shifts reaches 3.5.
///
/// The turn is the length at which impressions, each moved by it against the others and against itself, are alike as
/// the pairs are where they lie, and not as chance is (15 to 90 mm, cylinder seals are 20 to 80 round): with n places
/// of a figure's size, likeness r and that of the pairs, p, each meeting counts n p (2 r - p) / 2, the logarithm of
/// the ratio of both likelihoods. So many places that are half alike, as a row of worshippers is to itself, count
/// against a turn. It is found where that is at least 6 in all and 1.3 times that of any other length.
/// `turn_mm` more than 0: said; less: not looked for.
SealPlacing place_impressions(const std::vector<SealImpression>& impressions, std::size_t first, double turn_mm);

}  // namespace dubsar
