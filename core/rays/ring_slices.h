#pragma once
// Slices of a scan with what of them is clay or air for sure, for the search of rings.

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/rays/polar_sums.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// Slices of the scan, each with what of it is sure at half the resolution.
struct RingSlices {
  std::int64_t first = 0;  ///< slice of the scan, where they are neighbours
  std::vector<std::vector<float>> values;
  std::vector<std::vector<Material>> sure;
};

/// Reads slice `z`. Sure is what lies a step of half the resolution away from the other side of `level` in all
/// directions. Errors of the sources.
Result<void> add_slice(SlabSource& scan, SlabSource& half, std::int64_t z, float level, RingSlices& slices);

/// The same for slices that are neighbours, but what is thinner than two such steps in rows and columns of a slice is
/// no other side: a ring that reaches it, and also a narrow gap, whose voxels are sure then.
Result<void> take_thin_for_rings(SlabSource& half, float level, RingSlices& slices);

/// Of each slice.
std::vector<PolarSums> sums_of(const PolarSlice& polar, const RingSlices& slices);
PolarSums all_of(const std::vector<PolarSums>& sums);

}  // namespace dubsar
