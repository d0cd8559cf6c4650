#pragma once
// What a run will take, from some slices of the scan: they go through the stages that work on voxels, which says how
// much surface there is and how quick this machine is. The costs are those of the plan (plan.h).

#include <cstdint>
#include <optional>

#include "core/pipeline/detail.h"
#include "core/pipeline/rays_stage.h"

namespace dubsar {

struct Forecast {
  DetailChoice detail;
  std::optional<BentRays> bent_rays;  ///< that will be straightened; where artefacts were looked for
  std::optional<RingsLook> rings;     ///< that will be taken off
  std::optional<Holder> holder;       ///< that the object stands in
  SeenBend seen_bend;                 ///< of rays, where none will be straightened
  RunShape run;                       ///< with the vertices, the readings and the speed that were found
  RunCost cost;                       ///< with the threads that are set (parallel.h), beside the program itself
  double memory_bytes() const noexcept { return cost.bytes + 30e6; }  ///< most at any time, the program included
};

/// `wanted`: what the run is to do; scan, grid and vertices are filled in. Reads about 96 slices of the scan, and where
/// rays are looked for a part of all. Within 30 % on phantoms of 10 to 3,000 million voxels (docs/speed.md). Errors:
/// those of the source; kBadData when no threshold can be given or there is no surface; kCancelled.
Result<Forecast> forecast(SlabSource& scan, const RunShape& wanted, Detail detail, const Budget& budget,
                          std::optional<float> left_out, bool look_for_rays, Progress& progress);

}  // namespace dubsar
