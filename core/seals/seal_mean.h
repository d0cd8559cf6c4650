#pragma once
// Impressions that lie on each other as one relief: which of them shows a place, and which is worn there.

#include <vector>

#include "core/seals/relief_level.h"

namespace dubsar {

/// What one turn of one impression has over the seal's raster.
struct SealView {
  std::size_t impression;
  SealImpression over;
};

/// The mean of all views but those of one impression (`without`; more than there are: none is left out), and how many
/// show each place, if asked for. All of one raster.
///
/// A view shows a place or is worn level there. With its height z, what the seal stands out there, r, and an error of
/// .07 mm (places that are .1 to .2 mm off, on flanks, and the ground), the logarithm of how much more likely it is
/// that it shows it than that it is worn is r (2 z - r) / (2 .07^2): nothing on the seal's ground. What wears is as
/// large as figures, so it is averaged over a limb's neighbourhood (.8 mm), of some six independent places. Heights
/// count by that probability, r is their mean, and both are found in turns (expectation, maximization; A. Dempster, N.
/// Laird, D. Rubin 1977), from the mean of what stands out most. What is broken away does not count, what lies below
/// the ground hardly.
SealImpression mean_of_views(const std::vector<SealView>& views, std::size_t without, std::vector<float>* seen_by);

}  // namespace dubsar
