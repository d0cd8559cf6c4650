#pragma once
// A scan at a size at which its artefacts are looked for.

#include "core/base/progress.h"
#include "core/volume/slab_source.h"

namespace dubsar {

struct CoarseVolume {
  Volume<float> volume;
  std::int64_t cell =
      1;  ///< voxels of the source along each axis; what does not fill a cell at the far ends is left out
};

/// Means of cells: cell x cell voxels of the slice through the middle of each layer of cells, so that few slices are
/// read. The cell is the smallest power of two that leaves at most `widest` cells along each axis. Advances `progress`
/// by voxels of the source that were read. Errors: those of the source, kCancelled.
Result<CoarseVolume> read_coarse_volume(SlabSource& source, std::int64_t widest, Progress& progress);

}  // namespace dubsar
