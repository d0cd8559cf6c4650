#pragma once
// Where in a scan its surface can be, as the same scan at half the resolution shows it.

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/volume/brick_mask.h"
#include "core/volume/slab_source.h"

namespace dubsar {

struct NearSurfaceOptions {
  float threshold = 0.0f;
  float margin = 0.0f;     ///< grey values this close to the threshold may hide a surface that 2:1 has blurred away
  std::int64_t reach = 4;  ///< points of the scan around a place, along each axis, that belong to it
};

/// Bricks of the scan's grid.
struct NearSurface {
  BrickMask near;    ///< there may be surface
  BrickMask inside;  ///< of the others: all of it is on the inner side. Neighbours along an axis agree
};

/// `half` is the scan after 2:1 (core/filter/resample.h) and filters, `scan` has the dims of what it was made of. A
/// brick is near when a point of `half` within reach of it is within the margin of the threshold, or has a neighbour
/// along an axis on the other side of it. All bricks are near where the scan has less than 16 points along an axis.
/// Reads `half` once; the same for any number of threads. Errors of `half`, kCancelled.
Result<NearSurface> mark_near_surface(SlabSource& half, const Dims& scan, const NearSurfaceOptions& options,
                                      Progress& progress);

}  // namespace dubsar
