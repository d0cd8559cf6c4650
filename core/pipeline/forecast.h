#pragma once
// What a run will take, from some slices of the scan: they go through the stages that work on voxels, which says how
// much surface there is and how quick this machine is.

#include <cstdint>
#include <optional>

#include "core/pipeline/rays_stage.h"
#include "core/pipeline/volume_stages.h"

namespace dubsar {

struct ForecastOptions {
  Detail detail = Detail::kAuto;
  bool contact = true;       ///< is looked for where tablet and envelope touch
  int occlusion_rays = 160;  ///< per vertex; 0: none
  bool artefacts = false;    ///< are looked for, too: reads the scan where it is small, of a large one a part
  Budget budget = {};
  std::optional<float> left_out = std::nullopt;  ///< value of voxels that are no measurement
};

struct Forecast {
  DetailChoice detail;
  std::optional<BentRays> bent_rays;  ///< that will be straightened; where artefacts were looked for
  Dims grid;                          ///< after resampling
  std::int64_t vertices = 0;          ///< of the surface, about
  double core_s = 0.0;                ///< seconds of one core
  double wall_s = 0.0;                ///< by the clock, with the threads that are set (parallel.h), nobody else at work
  std::uint64_t memory_bytes = 0;     ///< most at any time
  std::uint64_t scratch_bytes = 0;    ///< on the disk while it runs
  std::uint64_t product_bytes = 0;    ///< of the EXA file
};

/// Memory of the stages that work on the surface, for each vertex: measured (docs/speed.md).
inline constexpr double kSurfaceBytesPerVertex = 200.0;

/// The grid on which the surface of a scan is found.
Dims grid_of(const Dims& scan, bool half);

/// What decides how much memory a run takes.
struct RunShape {
  Dims scan;
  bool half = true;       ///< the surface is that of the halved grid; else it is refined at the scan's resolution
  double vertices = 0.0;  ///< of the surface
  GridPlace place = GridPlace::kMemory;  ///< of the halved grid
  bool contact = false;                  ///< is traced
};

/// Most that a run takes at any time beside the program itself.
std::uint64_t bytes_of_run(const RunShape& run);

/// Vertices of the surface of a tablet in its envelope at the scan's resolution, from the size of the scan alone.
double usual_vertices(const Dims& scan);

/// Reads about 96 slices of the scan. Within 30 % on phantoms of 10 to 3,000 million voxels (docs/speed.md). Errors:
/// those of the source; kBadData when no threshold can be given or there is no surface; kCancelled.
Result<Forecast> forecast(SlabSource& scan, const ForecastOptions& options, Progress& progress);

}  // namespace dubsar
