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
};

struct HoleReport {
  std::int64_t loops = 0;         ///< holes between parts, each filled once for both sides
  std::int64_t unshared = 0;      ///< holes where three parts meet, filled for each part by itself
  std::int64_t longest_loop = 0;  ///< vertices
  std::int64_t triangles = 0;     ///< of all patches, each counted once
  double area = 0.0;              ///< of the patches between parts, grid steps squared
};

/// Fills every border between parts and stores the patches in the model (old ones are dropped), then measures the
/// partitions (surface_model.h). Borders of an open volume stay open, and those between partitions of one part: a crack
/// through the envelope is its outside's and its inside's. kBadData: the model is not segmented or contradicts itself;
/// kCancelled. Deterministic for any thread count. Cost: see fill_loop().
Result<HoleReport> fill_holes(SurfaceModel& model, const HoleOptions& options, Progress& progress);
/// The same with the graph of the model's faces.
Result<HoleReport> fill_holes(SurfaceModel& model, const FaceGraph& graph, const HoleOptions& options,
                              Progress& progress);

}  // namespace dubsar
