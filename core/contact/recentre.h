#pragma once
// The smooth patches over a large contact miss it: fairing knows the rim and nothing of the middle. Where a film shows,
// the guess moves to it before it is looked at closely.

#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/band.h"
#include "core/contact/dips.h"
#include "core/contact/rules.h"
#include "core/extract/bit_volume.h"
#include "core/volume/slab_source.h"

namespace dubsar {

struct Recentred {
  float longest = 0.0f;  ///< way of a sample, grid steps
  BandDensity density;   ///< raw, of the samples' grid: much or all of what is needed where they are now
};

/// Moves samples of the patches along their normals to the ground of the contact, from which wedges go down: the clay
/// within 12 grid steps of them is divided, and the heights of what divides it, of its upper part, are averaged over
/// some 10 steps. Samples where no film shows move as far as those around them that know better, less with the
/// distance. Those that move more than 3 steps, and what is within 24 of them, look anew from there, four times at
/// most: a patch that cuts a corner of the tablet off may be 30 steps from it. `inside`: the signs of the grid;
/// `density`: the scan on it, unfiltered. Deterministic for any thread count. Errors of `density`, kCancelled.
Result<Recentred> recentre_samples(std::vector<PatchPoint>& samples, const BitVolume& inside, SlabSource& density,
                                   Progress& progress, ContactRules rules = {});

/// The same on a grid of half the resolution, for that of the scan: twice as far, an eighth of the points. About a
/// third of what the contact takes afterwards, each time. What was read is kept from look to look, and freed at the
/// end.
Result<Recentred> recentre_samples_at_half(std::vector<PatchPoint>& samples, const BitVolume& inside,
                                           SlabSource& density, Progress& progress, ContactRules rules = {});

}  // namespace dubsar
