#include "core/pipeline/room_check.h"

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/pipeline/forecast.h"

namespace dubsar {
namespace {

/// Vertices of a voxel of the grid: more than scans of tablets have (phantoms .004 to .03, a noisy gyroid .04), so that
/// most scans need not be looked at.
constexpr double kMostVerticesPerVoxel = 0.08;
/// Of what the plan says is needed at least.
constexpr double kSurely = 0.75;
constexpr double kForetold = 0.1;  ///< so many vertices more than foretold there can be

/// Layers of chunks stay in memory up to a quarter of the budget (GridSource).
double layer_bytes(const ImportedVolume& scan, const Budget& budget) {
  const std::int64_t layer = scan.preferred_height();
  const double bytes = layer > 1 ? 4.0 * static_cast<double>(layer * scan.dims().slice()) : 0.0;
  return std::min(bytes, static_cast<double>(budget.kept_bytes()));
}

}  // namespace

Result<FittingRun> fit_run(ImportedVolume& scan, const RunShape& wanted, Detail detail, const Budget& budget,
                           StageRun run) {
  FittingRun fitting{{}, wanted, available_memory_bytes()};
  RunShape& shape = fitting.run;
  if (memory_limit() == 0) fitting.room = static_cast<std::uint64_t>(static_cast<double>(fitting.room) / kSurely);
  shape.scan = scan.dims();
  shape.threads = thread_count();
  shape.half_place = place_for(grid_of(shape.scan, true), budget);
  shape.layer_bytes = layer_bytes(scan, budget);
  shape.vertices = usual_vertices(shape.scan);
  fitting.detail = choose_detail(detail, shape, fitting.room);
  shape.half = fitting.detail.resample();
  const Dims grid = grid_of(shape.scan, shape.half);
  shape.vertices = 0.0;
  DUBSAR_TRY(check_fits(shape, fitting.room));
  shape.vertices = kMostVerticesPerVoxel * static_cast<double>(grid.count());
  const bool surely = check_fits(shape, fitting.room).has_value();
  shape.vertices = usual_vertices(grid);
  if (surely) return fitting;

  run.clock.start("forecast", "voxel");
  DUBSAR_ASSIGN(const Unmeasured unmeasured, scan.unmeasured());
  const Result<Forecast> expected = forecast(scan, shape, detail, budget, unmeasured.left_out(), false, run.progress);
  run.clock.finish(scan.dims().count());
  if (!expected) {
    const ErrorKind kind = expected.error().kind;
    if (kind == ErrorKind::kCancelled || kind == ErrorKind::kTryAgain) return tl::unexpected<Error>(expected.error());
    return fitting;  // nothing can be foretold
  }
  fitting.detail = expected->detail;
  shape = expected->run;
  shape.vertices *= 1.0 + kForetold;
  DUBSAR_TRY(check_fits(shape, fitting.room));
  return fitting;
}

}  // namespace dubsar
