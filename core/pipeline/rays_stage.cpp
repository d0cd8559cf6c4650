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
/// Of the air's unevenness that the right axis leaves in the halved grid.
constexpr double kMostAirOfAxis = 0.7;
/// A crossing of a large grid takes less than one in the search, where ramps and sums over few planes weigh more: .55
/// to .67 of it at 512x272x472 and 1000x534x920 voxels by 16 threads.
constexpr double kLargeFactor = 0.65;

/// What is found has lengths in voxels of the scan.
Result<CurveSearch> search_in(SlabSource& source, std::int64_t widest, const CurveTrial* known, double voxels_a_step,
                              StageRun run) {
  DUBSAR_ASSIGN(const CoarseVolume coarse, read_coarse_volume(source, widest, run.progress));
  const Dims d = coarse.volume.dims;
  const std::int64_t margin = std::max(kLeastRaysMargin, std::max({d.x, d.y, d.z}) / kMarginOfWidth);
  const double step = static_cast<double>(coarse.cell) * voxels_a_step;
  const auto in_steps = [](const std::shared_ptr<const ScatterField>& stray, double voxels) {
    return stray ? std::make_shared<const ScatterField>(stray->in_steps_of(voxels)) : nullptr;
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
  if (bent.stray) options.stray = std::make_shared<const ScatterField>(bent.stray->in_steps_of(voxels_a_step));
  DUBSAR_ASSIGN(Straightened done, straighten(grid, options, run.progress));
  done.axis_shift.pixels *= voxels_a_step;
  run.clock.finish(grid.dims().count());
  return done;
}

Result<GridStore> copy_of(GridStore& grid, GridPlace place, const Budget& budget) {
  const Dims dims = grid.dims();
  DUBSAR_ASSIGN(GridStore copy, GridStore::create(dims, grid.frame(), place, budget));
  constexpr std::int64_t kSlicesAtOnce = 32;
  for (std::int64_t z = 0; z < dims.z; z += kSlicesAtOnce) {
    const std::int64_t end = std::min(dims.z, z + kSlicesAtOnce);
    DUBSAR_TRY(grid.read(z, end, copy.page(z, end)));
    DUBSAR_TRY(copy.store(z, end));
  }
  return copy;
}

/// Rays of what the surface is found in, and all that was learned from it before.
Result<Straightened> straighten_imported(ImportedGrid& imported, const BentRays& bent, GridPlace place,
                                         const Budget& budget, StageRun run) {
  CountedGrid& half = imported.grid;
  Straightened done;
  if (imported.detail.resample()) {
    DUBSAR_ASSIGN(done, straighten_grid(half.grid, bent, 2.0, run));
    DUBSAR_ASSIGN(half.counts, count_values(half.grid, run.progress));
    DUBSAR_ASSIGN(GridStore kept, copy_of(half.grid, place, budget));
    imported.straightened = std::make_unique<GridStore>(std::move(kept));
  } else {
    DUBSAR_ASSIGN(CountedGrid scan, read_grid(imported.unbent(), false, place, budget, run));
    DUBSAR_ASSIGN(done, straighten_grid(scan.grid, bent, 1.0, run));
    DUBSAR_ASSIGN(half, read_grid(scan.grid, true, place_for(half.grid.dims(), budget), budget, run));
    imported.straightened = std::make_unique<GridStore>(std::move(scan.grid));
  }
  DUBSAR_TRY(measure_blur(imported, run));
  return done;
}

/// Takes rings off the scan, where it has any, and reads it again.
Result<void> take_rings_off(ImportedGrid& imported, const GreyLevels& levels, const Budget& budget, StageRun run) {
  run.clock.start("rings", "voxel");
  DUBSAR_ASSIGN(std::optional<FoundRings> rings, find_rings(*imported.scan, imported.grid.grid, levels, run.progress));
  run.clock.finish(imported.scan->dims().count());
  if (!rings) return {};
  log_info("{}", describe(rings->report));
  imported.facts.rings = rings->report;
  imported.ringless = std::make_unique<RinglessSource>(*imported.scan, std::move(rings->field));
  CountedGrid& half = imported.grid;
  const Dims dims = half.grid.dims();
  half.grid.release();
  DUBSAR_ASSIGN(half, read_grid(imported.unbent(), true, place_for(dims, budget), budget, run));
  return measure_blur(imported, run);
}

/// In the halved grid, where rays are straight.
Result<std::optional<BentRays>> look_for_axis_alone(GridStore& half, const GreyLevels& levels, StageRun run) {
  if (!(levels.contrast() > 0.0)) return std::nullopt;
  run.clock.start("axis", "voxel");
  const double before_s = process_cpu_seconds();
  std::optional<BentRays> found;
  double least = kMostAirOfAxis, crossings = 0.0;
  for (const TurnAxis axis : {TurnAxis::kZ, TurnAxis::kY, TurnAxis::kX}) {
    if (run.progress.cancelled()) return cancelled_error();
    StraightenOptions options{axis, levels, {}};
    options.curve.longest = static_cast<double>(std::max({half.dims().x, half.dims().y, half.dims().z}));
    DUBSAR_ASSIGN(const AxisShift shift, find_shift_in(half, options));
    crossings += crossings_of(half.dims(), axis);
    log_debug("axis {}: off by {:.2f} voxel{}, {:.2f} of the air's unevenness left", "xyz"[static_cast<int>(axis)],
              2.0 * shift.pixels, shift.flipped ? ", flipped" : "", shift.left);
    if (shift.left >= least) continue;
    least = shift.left;
    found.emplace();
    found->axis = axis;
    found->levels = levels;
    found->curve = options.curve.in_steps_of(0.5);
    found->longest_vox = found->curve.longest;
  }
  run.clock.finish(half.dims().count());
  if (found) found->crossing_s = kLargeFactor * (process_cpu_seconds() - before_s) / crossings;
  return found;
}

}  // namespace

Result<RaysLook> look_for_bent_rays(Overview overview, SlabSource& scan, StageRun run) {
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
  RaysLook look;
  look.levels = quick.levels;
  for (const CurveTrial& trial : quick.trials) {
    const double share = trial.elsewhere.sure() ? std::max(0.0, 1.0 - trial.left()) : 0.0;
    if (look.seen.bend == 0.0 || share > look.seen.share) look.seen = {trial.bend(), share};
  }
  if (!search.found) return look;
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
  look.bent = bent;
  return look;
}

void plan_straightening(RunShape& run, const BentRays& bent, std::uint64_t room) {
  run.straight =
      StraightPlan{GridPlace::kMemory, bent.crossing_s * crossings_of(grid_of(run.scan, run.half), bent.axis)};
  if (cost_of(run).bytes > static_cast<double>(room)) run.straight->place = GridPlace::kScratch;
}

Result<RaysReport> straighten_rays(ImportedGrid& imported, RunShape& shape, std::uint64_t room, const Budget& budget,
                                   StageRun run) {
  RaysReport report;
  DUBSAR_ASSIGN(const RaysLook look, look_for_bent_rays({imported.grid.grid, 2.0}, *imported.scan, run));
  DUBSAR_TRY(take_rings_off(imported, look.levels, budget, run));
  report.bent = look.bent;
  report.seen = look.seen;
  if (!report.bent) {
    DUBSAR_ASSIGN(report.bent, look_for_axis_alone(imported.grid.grid, look.levels, run));
  }
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
