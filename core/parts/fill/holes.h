#pragma once
// Closes the holes that segmentation cut into the parts (paper section 3.3; Barequet and Sharir 1995; Liepa
// 2003).

#include <cstdint>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/parts/face_graph.h"
#include "core/parts/fill/loop_fill.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct HoleOptions {
  LoopFillOptions fill;
  bool keep_patches = false;  ///< the model's patches between parts stay, and what they close is no hole
  bool measure = true;        ///< false: the partitions are not measured, and `watertight` says nothing
};

struct HoleReport {
  std::int64_t loops = 0;         ///< holes between parts, each filled once for both sides
  std::int64_t membranes = 0;     ///< holes between partitions of one part (cracks)
  std::int64_t unshared = 0;      ///< holes where three parts meet, filled for each part by itself
  std::int64_t longest_loop = 0;  ///< vertices
  std::int64_t triangles = 0;     ///< of all patches, each counted once
  double area = 0.0;              ///< of the patches between parts, grid steps squared
  bool watertight = false;        ///< every partition is closed and manifold now
};

/// Fills every border between partitions and stores the patches in the model (old ones are dropped), then
/// measures the partitions (surface_model.h). Borders of an open volume stay open. A partition that cannot be
/// closed says so in `watertight`, and the log says why. kBadData: the model is not segmented or contradicts
/// itself; kCancelled. Deterministic for any thread count. Cost: see fill_loop().
Result<HoleReport> fill_holes(SurfaceModel& model, const HoleOptions& options, Progress& progress);
/// The same with the graph of the model's faces.
Result<HoleReport> fill_holes(SurfaceModel& model, const FaceGraph& graph, const HoleOptions& options,
                              Progress& progress);

}  // namespace dubsar
