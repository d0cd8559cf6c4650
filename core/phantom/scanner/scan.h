#pragma once
// A scan of an object: projections, what the panel makes of them, and the volume that a scanner writes.

#include "core/base/progress.h"
#include "core/phantom/scanner/geometry.h"
#include "core/volume/slab_source.h"

namespace dubsar::phantom {

struct ScannedVolume {
  Volume<float> per_mm;  ///< attenuation
  ScanGeometry geometry;
  double longest_mm = 0.0;                       ///< path through clay
  double least_light = 1.0;                      ///< behind it, of the open beam, without scatter
  double stray_light = 0.0;                      ///< scatter there, of the open beam
  double clay_per_mm = 0.0, water_per_mm = 0.0;  ///< of the first millimetre in this beam
};

/// Scans `object`, densities relative to clay at voxels of `voxel_mm`; the grid of the result is that of the object.
/// Memory: 4 bytes a voxel twice, and 4 bytes a pixel and view; kTryAgain where the machine has less left. kUsage,
/// kCancelled. Stages "project", "expose", "reconstruct". All threads, the same bits for any number; those of two kinds
/// of processors may differ in the last places of logarithms.
Result<ScannedVolume> scan_object(SlabSource& object, double voxel_mm, const ScannerOptions& options,
                                  std::uint64_t seed, Progress& progress);

}  // namespace dubsar::phantom
