#include "core/pipeline/rays_stage.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/clock.h"
#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/filter/histogram.h"
#include "core/rays/coarse_volume.h"
#include "core/rays/straighten.h"

namespace dubsar {
namespace {

/// Cells along the longest axis where rays are looked for, and where they are measured: with 128 cells bends of 4 come
/// out as 2.5.
constexpr std::int64_t kQuickWidest = 128, kFineWidest = 320;
/// How far from the other material clay and air are sure: a part of the longest axis, but a few cells at least.
constexpr std::int64_t kMarginOfWidth = 43, kLeastRaysMargin = 3;
/// Slices of a large grid do not stay in the caches as those of the search do.
constexpr double kLargeFactor = 1.5;

/// What is found has lengths in voxels of the scan.
Result<CurveSearch> search_in(SlabSource& source, std::int64_t widest, const CurveTrial* known, double voxels_a_step,
                              StageRun run) {
  DUBSAR_ASSIGN(const CoarseVolume coarse, read_coarse_volume(source, widest, run.progress));
  const Dims d = coarse.volume.dims;
  const std::int64_t margin = std::max(kLeastRaysMargin, std::max({d.x, d.y, d.z}) / kMarginOfWidth);
  const double step = static_cast<double>(coarse.cell) * voxels_a_step;
  const auto in_steps = [](const std::shared_ptr<const StrayField>& stray, double voxels) {
    return stray ? std::make_shared<const StrayField>(stray->in_steps_of(voxels)) : nullptr;
  };
  const std::optional<TurnAxis> only = known ? std::optional(known->axis) : std::nullopt;
  DUBSAR_ASSIGN(CurveSearch search, search_curve(coarse.volume, margin, only,
                                                 known ? in_steps(known->stray, step) : nullptr, run.progress));
  if (search.found) {
    search.found->curve = search.found->curve.in_steps_of(1.0 / step);
    search.found->stray = in_steps(search.found->stray, 1.0 / step);
  }
  return search;
}

Result<Straightened> straighten_grid(GridStore& grid, const BentRays& bent, double voxels_a_step, StageRun run) {
  run.clock.start("straighten", "voxel");
  run.progress.begin("straighten", grid.dims().count(), "voxel");
  StraightenOptions options{bent.axis, bent.levels, bent.curve.in_steps_of(voxels_a_step)};
  if (bent.stray) options.stray = std::make_shared<const StrayField>(bent.stray->in_steps_of(voxels_a_step));
  DUBSAR_ASSIGN(Straightened done, straighten(grid, options, run.progress));
  done.axis_shift.pixels *= voxels_a_step;
  run.clock.finish(grid.dims().count());
  return done;
}

Result<GridStore> copy_of(GridStore& grid, GridPlace place, const Budget& budget) {
  const Dims dims = grid.dims();
  DUBSAR_ASSIGN(GridStore copy, GridStore::create(dims, grid.frame(), place, budget));
  for (std::int64_t z = 0; z < dims.z; ++z) {
    DUBSAR_TRY(grid.read(z, z + 1, copy.page(z, z + 1)));
    DUBSAR_TRY(copy.store(z, z + 1));
  }
  return copy;
}

/// Rays of what the surface is found in, and all that was learned from it before.
Result<Straightened> straighten_imported(ImportedGrid& imported, const BentRays& bent, GridPlace place,
                                         const Budget& budget, StageRun run) {
  CountedGrid& half = imported.grid;
  Straightened done;
  if (imported.detail.resample()) {
    DUBSAR_ASSIGN(GridStore grid, copy_of(half.grid, place, budget));
    DUBSAR_ASSIGN(done, straighten_grid(grid, bent, 2.0, run));
    DUBSAR_ASSIGN(half.counts, count_values(grid, run.progress));
    DUBSAR_ASSIGN(half.grid, copy_of(grid, place_for(grid.dims(), budget), budget));
    imported.straightened = std::make_unique<GridStore>(std::move(grid));
  } else {
    DUBSAR_ASSIGN(CountedGrid scan, read_grid(*imported.scan, false, place, budget, run));
    DUBSAR_ASSIGN(done, straighten_grid(scan.grid, bent, 1.0, run));
    DUBSAR_ASSIGN(half, read_grid(scan.grid, true, place_for(half.grid.dims(), budget), budget, run));
    imported.straightened = std::make_unique<GridStore>(std::move(scan.grid));
  }
  DUBSAR_TRY(measure_blur(imported, run));
  return done;
}

}  // namespace

Result<std::optional<BentRays>> look_for_bent_rays(Overview overview, SlabSource& scan, StageRun run) {
  run.clock.start("rays", "voxel");
  run.progress.begin("rays", 0, "voxel");
  const double before_s = process_cpu_seconds();
  DUBSAR_ASSIGN(const CurveSearch quick, search_in(overview.grid, kQuickWidest, nullptr, overview.voxels_a_step, run));
  const double search_s = process_cpu_seconds() - before_s;
  CurveSearch search = quick;
  if (quick.found) {
    DUBSAR_ASSIGN(search, search_in(scan, kFineWidest, &*quick.found, 1.0, run));
    if (!search.found) search = quick;  // at a finer grid noise can hide what is there
  }
  run.clock.finish(std::max<std::int64_t>(1, quick.crossings));
  if (!search.found) return std::nullopt;
  const CurveTrial& found = *search.found;
  BentRays bent;
  bent.axis = found.axis;
  bent.curve = found.curve;
  bent.levels = search.levels;
  bent.before = found.before;
  bent.after = found.after;
  bent.stray = found.stray;
  bent.longest_vox = bent.curve.value(bent.curve.longest, bent.curve.longest_stray);
  bent.contrast = bent.curve.contrast();
  bent.cut_by_border = search.cut_by_border;
  bent.crossing_s = kLargeFactor * search_s / static_cast<double>(quick.crossings);
  return std::optional(bent);
}

void plan_straightening(RunShape& run, const BentRays& bent, std::uint64_t room) {
  run.straight =
      StraightPlan{GridPlace::kMemory, bent.crossing_s * crossings_of(grid_of(run.scan, run.half), bent.axis)};
  if (cost_of(run, 1).bytes > static_cast<double>(room)) run.straight->place = GridPlace::kScratch;
}

Result<RaysReport> straighten_rays(ImportedGrid& imported, RunShape& shape, std::uint64_t room, const Budget& budget,
                                   StageRun run) {
  RaysReport report;
  DUBSAR_ASSIGN(report.bent, look_for_bent_rays({imported.grid.grid, 2.0}, *imported.scan, run));
  if (!report.bent) return report;
  const RunShape before = shape;
  plan_straightening(shape, *report.bent, room);
  log_info("rays are straightened, which takes about {:.0f} s of {} threads",
           std::ceil(shape.straight->core_s / thread_count()), thread_count());
  const Result<Straightened> done = straighten_imported(imported, *report.bent, shape.straight->place, budget, run);
  if (done)
    report.straightened = *done;
  else if (done.error().kind == ErrorKind::kTryAgain)
    report.why_not = done.error().message, shape = before;
  else
    return tl::unexpected<Error>(done.error());
  const std::string text = rays_text(report, imported.scan->frame());
  log(report.straightened ? LogLevel::kInfo : LogLevel::kWarning, text);
  log_info("{}", kAdviceForBentRays);
  return report;
}

}  // namespace dubsar
