#include "core/pipeline/forecast.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/extract/bit_volume.h"
#include "core/extract/extract.h"
#include "core/filter/resample.h"
#include "core/pipeline/tapped_source.h"

namespace dubsar {
namespace {

/// Groups of slices that are filtered together; what lies next to a group's border is not looked at.
constexpr std::int64_t kGroups = 8, kGroupAfter = 6;

// Seconds of one core for a million vertices, of the stages that work on surfaces; measured on phantoms
// (docs/speed.md).
constexpr double kSurfaceSeconds = 6.0;
constexpr double kSecondsPerRay = 1.0 / 21e6;
constexpr double kContactSeconds = 6.0;
// The rest of memory: the program, its slabs and threads; and, for each vertex, all that is there while the contact is
// traced.
constexpr double kProgramBytes = 80e6, kContactBytesPerVertex = 480.0;
// Points of the bricks near the surface, and what filtering one costs: passes see beyond the bricks.
constexpr double kBandPointsPerVertex = 14.0, kBandEffort = 1.8;
constexpr std::int64_t kLearnedSlices = 96;  ///< of the scan, that are filtered in whole (refine_stage.cpp)
/// Of phantoms from 96x64x96 to 1871x999x1723: 7 to 10.
constexpr double kVerticesPerArea = 10.0;
// Where the outside is looked for: volumes of signs that are there at a time, and what is known of each vertex.
constexpr double kSignVolumes = 6.5, kSegmentBytesPerVertex = 125.0;
constexpr double kProductBytesPerVertex = 0.45, kLightBytesPerVertex = 0.07, kContactProductBytesPerVertex = 0.3;
constexpr double kExtractOfDenoising = 0.3;  ///< what sharpening and extraction take of the time of the filter's passes
constexpr double kEfficiency = 0.85;         ///< of more than one thread

/// Cells with corners on both sides between two slices.
std::int64_t active_cells(const BitVolume& signs) {
  const Dims d = signs.dims();
  std::int64_t cells = 0;
  for (std::int64_t z = 0; z + 1 < d.z; ++z)
    for (std::int64_t y = 0; y + 1 < d.y; ++y)
      for (std::int64_t x = 0; x + 1 < d.x; ++x) {
        int inside = 0;
        for (int corner = 0; corner < 8; ++corner)
          inside += signs.get(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)) ? 1 : 0;
        cells += inside != 0 && inside != 8 ? 1 : 0;
      }
  return cells;
}

/// Some slices of a grid as a volume of their own.
class Slices final : public SlabSource {
 public:
  Slices(SlabSource& source, std::int64_t begin, std::int64_t count)
      : source_(&source), begin_(begin), dims_{source.dims().x, source.dims().y, count} {}
  Dims dims() const noexcept override { return dims_; }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    return source_->read(begin_ + z_begin, begin_ + z_end, out);
  }

 private:
  SlabSource* source_;
  std::int64_t begin_;
  Dims dims_;
};

/// Layers of chunks that have to be decoded for one slice that is read: more than one where groups lie in deep layers.
double decoded_per_read(const SlabSource& scan, std::int64_t slices, std::int64_t group) {
  const std::int64_t layer = std::max<std::int64_t>(1, scan.preferred_height()), all = scan.dims().z;
  if (slices >= all || layer <= 1) return 1.0;
  const std::int64_t groups = slices / group;
  const double layers =
      static_cast<double>(groups) * std::ceil(static_cast<double>(group) / static_cast<double>(layer));
  return std::max(
      1.0, std::min(layers * static_cast<double>(layer), static_cast<double>(all)) / static_cast<double>(slices));
}

}  // namespace

Dims grid_of(const Dims& scan, bool half) {
  const auto halved = [&](std::int64_t n) { return half && n > 1 ? n / 2 : n; };
  return {halved(scan.x), halved(scan.y), halved(scan.z)};
}

double usual_vertices(const Dims& scan) {
  return kVerticesPerArea * std::pow(static_cast<double>(scan.count()), 2.0 / 3.0);
}

std::uint64_t bytes_of_run(const RunShape& run) {
  const double signs = static_cast<double>(grid_of(run.scan, run.half).count()) / 8.0;
  double floats = run.place == GridPlace::kMemory ? 4.0 * static_cast<double>(grid_of(run.scan, true).count()) : 0.0;
  if (!run.half) floats = std::max(floats, 4.0 * kBandPointsPerVertex * run.vertices);  // one after the other
  const double volume = signs + floats + 4.0 * run.vertices;
  const double surface = signs + run.vertices * kSurfaceBytesPerVertex;
  const double outside = kSignVolumes * signs + run.vertices * kSegmentBytesPerVertex;
  const double traced = run.contact ? kContactBytesPerVertex * run.vertices : 0.0;
  return static_cast<std::uint64_t>(std::max({surface, volume, outside, traced}));
}

Result<Forecast> forecast(SlabSource& scan, const ForecastOptions& options, Progress& progress) {
  Forecast result;
  const std::uint64_t left = options.budget.limit_bytes();
  result.detail = choose_detail(options.detail, scan.dims(), left);
  const bool half = result.detail.resample();
  const std::int64_t group = half ? 2 * kGroupAfter : kGroupAfter;
  SampledSource some(scan, kGroups * group, group);
  StageClock clock;
  SilentProgress silent;
  const StageRun run{clock, silent};
  if (progress.cancelled()) return cancelled_error();
  DUBSAR_ASSIGN(CountedGrid sampled, read_grid(some, half, options.budget, run));
  const double reading = 1.0 / decoded_per_read(scan, some.dims().z, group);
  if (progress.cancelled()) return cancelled_error();
  DUBSAR_ASSIGN(DenoisedGrid denoised, denoise(std::move(sampled), "sample", {}, {.left_out = options.left_out}, run));
  DUBSAR_ASSIGN(const Threshold threshold, choose_threshold(std::nullopt, denoised.steps.back().estimates));

  const Dims part = denoised.grid.dims();
  result.grid = grid_of(scan.dims(), half);
  const std::int64_t depth = std::min(part.z, kGroupAfter);
  std::int64_t cells = 0, layers = 0;
  for (std::int64_t z = 0; z + depth <= part.z; z += depth) {
    const std::int64_t first = part.z <= kGroupAfter ? 0 : z + depth / 2 - 1;
    const std::int64_t count = part.z <= kGroupAfter ? part.z : 2;
    Slices middle(denoised.grid, first, count);
    DUBSAR_ASSIGN(const SurfaceSamples samples, sample_surface(middle, {threshold.value, 4, false}, silent));
    cells += active_cells(samples.signs);
    layers += std::max<std::int64_t>(1, count - 1);
  }
  if (cells == 0)
    return fail(ErrorKind::kBadData, "there is no surface at threshold {:g} in the slices looked at", threshold.value);
  const auto all = static_cast<double>(result.grid.count());
  const double vertices = static_cast<double>(cells) / static_cast<double>(layers) * static_cast<double>(result.grid.z);
  result.vertices = static_cast<std::int64_t>(vertices);

  // What the stages took for these slices, for all.
  const double times = all / static_cast<double>(part.count());
  const double scan_z = static_cast<double>(scan.dims().z);
  const double band = std::min(1.0, kBandPointsPerVertex * vertices / all);
  const double filtered =
      half ? 1.0  // of the voxels
           : 1.0 / 8.0 + std::min(1.0, static_cast<double>(kLearnedSlices) / scan_z) + kBandEffort * band;
  const double readings = (half ? 1.0 : 2.0) * (options.contact ? 2.0 : 1.0);  // of the scan
  for (const StageRecord& stage : clock.records()) {
    if (stage.name == "estimate") continue;  // of a histogram: the same for any size
    result.core_s += stage.cpu_s * times *
                     (stage.name == "import"    ? readings * reading
                      : stage.name == "denoise" ? (1.0 + kExtractOfDenoising) * filtered
                                                : 1.0);
  }
  const double millions = vertices * 1e-6;
  result.core_s += kSurfaceSeconds * millions + kSecondsPerRay * vertices * options.occlusion_rays /
                                                    sharers_of_rays(result.detail.detail, result.vertices);
  if (options.contact) result.core_s += kContactSeconds * millions;
  if (options.artefacts) {
    DUBSAR_ASSIGN(result.bent_rays, look_for_bent_rays({scan, 1.0}, scan, {clock, progress}));
  }
  if (result.bent_rays) result.core_s += seconds_to_straighten(*result.bent_rays, result.grid);
  const int threads = thread_count();
  result.wall_s = threads > 1 ? result.core_s / (kEfficiency * threads) : result.core_s;

  const Dims halved = grid_of(scan.dims(), true);
  const GridPlace place = place_for(halved, options.budget);
  // What was straightened stays until contact is traced, beside the surface.
  const bool keeps = result.bent_rays && place_for(result.grid, options.budget) == GridPlace::kMemory;
  result.memory_bytes = static_cast<std::uint64_t>(kProgramBytes) +
                        (keeps ? 4 * static_cast<std::uint64_t>(result.grid.count()) : 0) +
                        bytes_of_run({scan.dims(), half, vertices, place, options.contact});
  result.scratch_bytes = place == GridPlace::kScratch ? 4 * static_cast<std::uint64_t>(halved.count()) : 0;
  if (result.bent_rays && !keeps) result.scratch_bytes += 4 * static_cast<std::uint64_t>(result.grid.count());
  result.product_bytes = static_cast<std::uint64_t>(
      vertices * (kProductBytesPerVertex + (options.occlusion_rays > 0 ? kLightBytesPerVertex : 0.0) +
                  (options.contact ? kContactProductBytesPerVertex : 0.0)));
  return result;
}

}  // namespace dubsar
