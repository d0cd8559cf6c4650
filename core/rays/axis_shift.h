#pragma once
// An axis of rotation that was not where the reconstruction took it: in scans of half a turn all rays are displaced on
// the detector, which is found and undone (after [Donath 2006]; here from the volume, by the air).

#include <functional>

#include "core/rays/parallel_rays.h"

namespace dubsar {

struct AxisShift {
  double pixels = 0.0;  ///< rays are where those `pixels` farther along the detector should be
  /// The half turn did not begin at direction 0 but at a right angle to it: rays of the first quarter are displaced the
  /// other way.
  bool flipped = false;
  double left = 1.0;  ///< of the squared unevenness of the air beside the object
};

/// What a row of recorded lengths is shorter than straight ones: (direction, recorded, bend).
using BendOfRow = std::function<void(std::int64_t, const float*, float*)>;

/// Moves all rays, by cubic interpolation. `in` and `out` have the same shape.
void shift_rays(const LaneSinogram& in, const AxisShift& shift, LaneSinogram& out);

/// The shift between -1.25 and 1.25 pixels that makes the air beside the object most even; none where that is below .08
/// pixel or less than a tenth of the unevenness goes, as in scans of a full turn. `planes`: in units of clay, lanes 2 k
/// and 2 k + 1 are planes of one place whose noise has nothing in common; `recorded` their projections; `bend`: of
/// lengths recorded along a direction, thread-safe. Cost: 5 backprojections, where there is one 3 more.
AxisShift find_axis_shift(const ParallelRays& rays, const LaneImage& planes, const LaneSinogram& recorded,
                          const BendOfRow& bend);

}  // namespace dubsar
