#pragma once
// How blurred a scan is: the spread of its edges, measured where its surface is flat.

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// Edges across an axis rise in two steps, those along it in one: the scanner turned wholly about an axis that was not
/// where the reconstruction took it, and each side of the turn has put the edge elsewhere. No blur and no window does
/// so: a line spread that is higher beside its middle than there has waves of negative contrast.
struct DoubleEdge {
  int axis = 2;         ///< 0 to 2: x, y, z of the grid
  double apart = 0.0;   ///< voxels from one step to the other: twice what the axis was off by
  double valley = 0.0;  ///< how much lower the slope is between the steps, 0 to 1
};

/// One sentence.
std::string describe(const DoubleEdge& edge);

struct EdgeSpread {
  double variance = 0.0;              ///< across a flat edge, voxels squared; the extent of a voxel (1/12) is in it
  double uncertainty = 0.0;           ///< of the variance, one standard deviation
  int places = 0;                     ///< flat pieces of surface that it was measured at
  std::optional<DoubleEdge> doubled;  ///< told from 100 places across an axis and along it on
};

/// Measures the spread between `air` and `material` (grey values) in balls of 5 voxels around the surface: where a
/// plane divides a ball, all its voxels are sorted by their distance from that plane (a slanted edge, so that nothing
/// is interpolated). Places with anything else in them (curves, gaps, pores) do not count. Nothing where fewer than 200
/// flat places are found, or where the variance is not twice its uncertainty and more than a voxel's extent makes: a
/// scan has a blur, so that what was measured there is something else (three densities, masks). At most 16 groups of 12
/// slices are read, in small scans, where they show few places, 128 that overlap: memory for one group. The same for
/// any number of threads. Errors of the source, kCancelled.
Result<std::optional<EdgeSpread>> measure_edge_spread(SlabSource& source, double air, double material,
                                                      Progress& progress);

}  // namespace dubsar
