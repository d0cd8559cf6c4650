#include "core/pipeline/forecast.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/extract/bit_volume.h"
#include "core/extract/extract.h"
#include "core/filter/resample.h"
#include "core/pipeline/tapped_source.h"
#include "core/pipeline/volume_stages.h"

namespace dubsar {
namespace {

/// Groups of slices that are filtered together; what lies next to a group's border is not looked at.
constexpr std::int64_t kGroups = 8, kGroupAfter = 6;

/// Seconds of one core for a voxel and pass of the filter on the machine of the plan (plan.cpp).
constexpr double kPlannedPass = 4e-9;
/// A machine is no quicker or slower than this: a few hundredths of a second are measured.
constexpr double kQuickest = 0.3, kSlowest = 5.0;

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

Result<Forecast> forecast(SlabSource& scan, const RunShape& wanted, Detail detail, const Budget& budget,
                          std::optional<float> left_out, bool look_for_rays, Progress& progress) {
  Forecast result;
  RunShape& run = result.run = wanted;
  const std::uint64_t room = available_memory_bytes();
  run.scan = scan.dims();
  run.threads = thread_count();
  run.half_place = place_for(grid_of(run.scan, true), budget);
  run.vertices = usual_vertices(run.scan);
  result.detail = choose_detail(detail, run, room);
  run.half = result.detail.resample();
  const std::int64_t group = run.half ? 2 * kGroupAfter : kGroupAfter;
  SampledSource some(scan, kGroups * group, group);
  StageClock clock;
  SilentProgress silent;
  const StageRun apart{clock, silent};
  if (progress.cancelled()) return cancelled_error();
  DUBSAR_ASSIGN(CountedGrid sampled,
                read_grid(some, run.half, place_for(grid_of(some.dims(), run.half), budget), budget, apart));
  const double read_points = static_cast<double>(some.dims().count()) * decoded_per_read(scan, some.dims().z, group);
  if (progress.cancelled()) return cancelled_error();
  DUBSAR_ASSIGN(DenoisedGrid denoised, denoise(std::move(sampled), "sample", {}, {.left_out = left_out}, apart));
  DUBSAR_ASSIGN(const Threshold threshold, choose_threshold(std::nullopt, denoised.steps.back().estimates));

  if (const Estimates& left = denoised.steps.back().estimates; !run.half && run.noise.passes > 0) {
    DUBSAR_ASSIGN(const std::optional<EdgeSpread> blur,
                  measure_edge_spread(denoised.grid, left.m_lo, left.m_hi, silent));
    run.noise.made_fair = blur && fairing_share(*blur, left.snr_db) > 0.0f;
  }

  const Dims part = denoised.grid.dims();
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
  run.vertices =
      static_cast<double>(cells) / static_cast<double>(layers) * static_cast<double>(grid_of(run.scan, run.half).z);
  if (detail == Detail::kAuto && !run.half && cost_of(run).bytes > static_cast<double>(room)) {
    result.detail = choose_detail(detail, run, room);
    run.half = true;
    run.vertices /= 4.0;
  }

  int passes = 0;
  double filtering = 0.0;
  for (const StageRecord& stage : clock.records()) {
    if (stage.name == "import") run.read_s = stage.cpu_s / read_points;
    if (stage.name != "denoise") continue;
    filtering += stage.cpu_s;
    ++passes;
  }
  if (passes > 0)
    run.slowness =
        std::clamp(filtering / (kPlannedPass * passes * static_cast<double>(part.count())), kQuickest, kSlowest);
  run.read_s /= run.slowness;
  if (look_for_rays) {
    DUBSAR_ASSIGN(RaysLook look, look_for_bent_rays({scan, 1.0}, scan, {clock, progress}));
    result.bent_rays = std::move(look.bent);
    result.seen_bend = look.seen;
    HalfResolutionSource halved(scan);
    DUBSAR_ASSIGN(result.rings, look_for_rings(scan, halved, look.levels, progress));
    DUBSAR_ASSIGN(const std::optional<FoundHolder> holder,
                  find_holder(scan, {.voxels_a_step = 1.0, .slices = 1, .left_out = left_out}, progress));
    if (holder) result.holder = holder->holder;
    if (result.bent_rays) plan_straightening(run, *result.bent_rays, room);
  }
  result.cost = cost_of(run);
  return result;
}

}  // namespace dubsar
