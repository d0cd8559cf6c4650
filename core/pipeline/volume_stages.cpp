#include "core/pipeline/volume_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/numbers/units.h"
#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "core/extract/extract.h"
#include "core/filter/resample.h"
#include "core/filter/sharpen.h"
#include "core/pipeline/tapped_source.h"
#include "core/relief/smoothing/fair_moves.h"
#include "core/volume/carried_source.h"

namespace dubsar {
namespace {

/// Slices of the raw scan that are enough to know its noise: its histogram is needed for the report only.
constexpr std::int64_t kRawSampleSlices = 48, kRawSampleGroup = 3;

Result<Estimates> estimate_source(SlabSource& source, std::string_view stage, const EstimateOptions& options,
                                  StageRun run) {
  run.clock.start(stage, "voxel");
  run.progress.begin(stage, source.dims().count(), "voxel");
  DUBSAR_ASSIGN(Estimates estimates, estimate(source, options, run.progress));
  run.clock.finish(source.dims().count());
  return estimates;
}

/// The whole source, slab by slab, into a store.
Result<CountedGrid> fill_grid(SlabSource& source, GridPlace place, const Budget& budget) {
  constexpr std::int64_t kSlabBytes = 16 << 20;  // in the caches, as far as possible, until its values are counted
  const Dims dims = source.dims();
  DUBSAR_ASSIGN(GridStore grid, GridStore::create(dims, source.frame(), place, budget));
  if (!grid.in_memory())
    log_info("the grid of {:.1f} GiB goes to the disk, in {}", gib_of(grid.scratch_bytes()),
             budget.scratch_folder.string());
  const std::int64_t slice_bytes = dims.slice() * std::int64_t{sizeof(float)}, layer = source.preferred_height();
  std::int64_t height = std::clamp<std::int64_t>(kSlabBytes / slice_bytes, 1, dims.z);
  if (static_cast<std::uint64_t>(layer * slice_bytes) <= budget.kept_bytes())
    height = (height + layer - 1) / layer * layer;
  ParallelCounts counts(dims);
  for (std::int64_t z = 0; z < dims.z; z += height) {
    const std::int64_t end = std::min(dims.z, z + height);
    const std::span<float> page = grid.page(z, end);
    DUBSAR_TRY(source.read(z, end, page));
    counts.add(z, page);
    DUBSAR_TRY(grid.store(z, end));
  }
  return CountedGrid{std::move(grid), counts.take()};
}

/// Share of the border that is material where an object is cut by the volume on some sides.
constexpr double kMostBorder = 0.6;

/// A surface and how its vertices would have to move to be fair.
struct FairSurface {
  std::vector<glm::vec3> places, moves;
};

Result<FairSurface> fair_surface(const SurfaceSamples& samples, double blur, Progress& progress) {
  DUBSAR_ASSIGN(QuadMesh mesh, build_quad_mesh(samples, progress));
  FairSurface fair;
  DUBSAR_ASSIGN(fair.moves, fair_moves(mesh, {.growth = static_cast<float>(blur)}, progress));
  fair.places = std::move(mesh.positions);
  return fair;
}

/// Sharpening by 1 may double the noise: from here on it leaves at least what a raw scan of the paper has (17 dB).
constexpr double kSharpenFromDb = 23.0, kAllFromDb = 27.0;

/// Noise of a surface, grid steps, from which it is made fair, and with which wholly: phantoms of 17 dB have .11 at a
/// point spread of .58 voxel (none is made fairer) and .15 at .9, those of 14 dB .17.
constexpr double kFairFrom = 0.12, kAllFairFrom = 0.145;

}  // namespace

Result<CountedGrid> read_grid(SlabSource& scan, bool resample, GridPlace place, const Budget& budget, StageRun run) {
  run.clock.start(resample ? "resample" : "import", "voxel");
  run.progress.begin("import", scan.dims().count(), "voxel");
  TappedSource tap(scan, run.progress);
  if (!resample) {
    DUBSAR_ASSIGN(CountedGrid grid, fill_grid(tap, place, budget));
    run.clock.finish(scan.dims().count());
    return grid;
  }
  HalfResolutionSource half(tap);
  DUBSAR_ASSIGN(CountedGrid grid, fill_grid(half, place, budget));
  run.clock.finish(scan.dims().count());
  run.clock.split_before_last("import", tap.wall_s(), tap.cpu_s(), scan.dims().count(), "voxel");
  return grid;
}

Result<void> measure_blur(ImportedGrid& imported, StageRun run) {
  run.clock.start("blur", "place");
  const bool halved = imported.detail.resample() && !imported.cleaned_is_half();
  SlabSource& grid = halved ? static_cast<SlabSource&>(imported.grid.grid) : imported.cleaned();
  const Estimates& raw = imported.raw.estimates;
  DUBSAR_ASSIGN(imported.facts.blur, measure_edge_spread(grid, raw.m_lo, raw.m_hi, run.progress));
  run.clock.finish(imported.facts.blur ? imported.facts.blur->places : 0);
  return {};
}

Result<ImportedGrid> import_grid(std::unique_ptr<ImportedVolume> opened, const DetailChoice& detail, GridPlace place,
                                 const Budget& budget, const EstimateOptions& estimate, StageRun run) {
  ImportedGrid imported;
  imported.scan = std::move(opened);
  ImportedVolume* const scan = imported.scan.get();
  DUBSAR_ASSIGN(imported.facts.unmeasured, scan->unmeasured());
  imported.estimate = estimate;
  imported.estimate.left_out = imported.facts.unmeasured.left_out();
  imported.detail = detail;
  const bool half = detail.resample();
  imported.facts.info = scan->info();
  imported.facts.frame = scan->frame();
  imported.facts.warnings = scan->info().warnings;
  // Of deep layers of chunks a few are decoded for it, not one for every group.
  const std::int64_t layer = scan->preferred_height();
  const std::int64_t group = std::clamp(std::min(layer, kRawSampleSlices / 4), kRawSampleGroup, kRawSampleSlices);
  SampledSource some(*scan, kRawSampleSlices, group);
  imported.raw.name = "raw";
  DUBSAR_ASSIGN(imported.raw.estimates, estimate_source(some, "estimate_raw", imported.estimate, run));
  DUBSAR_ASSIGN(imported.grid, read_grid(*scan, true, place, budget, run));
  DUBSAR_TRY(measure_blur(imported, run));
  ScanFacts& facts = imported.facts;
  facts.grid = half ? imported.grid.grid.dims() : scan->dims();
  facts.unmeasured_voxels = scan->unmeasured_counts();
  if (const std::int64_t voxels = facts.unmeasured_voxels.all(); voxels > 0) {
    facts.unmeasured.share = static_cast<double>(voxels) / static_cast<double>(scan->dims().count());
    facts.warnings.push_back(describe(facts.unmeasured));
    log(LogLevel::kWarning, facts.warnings.back());
  }
  if (const std::vector<std::int64_t> slices = scan->bridged(); !slices.empty()) {
    facts.warnings.push_back(describe_bridged(slices));
    log(LogLevel::kWarning, facts.warnings.back());
  }
  return imported;
}

Result<DenoisedGrid> denoise(CountedGrid grid, std::string name, const DenoiseOptions& options,
                             const EstimateOptions& estimating, StageRun run) {
  DenoisedGrid denoised{std::move(grid.grid), {}};
  GridStore& volume = denoised.grid;
  const std::int64_t voxels = volume.dims().count();
  const auto add_step = [&](std::string step, const ValueCounts& values) -> Result<void> {
    run.clock.start("estimate", "voxel");
    run.progress.begin("estimate", voxels, "voxel");
    DUBSAR_ASSIGN(Estimates estimates, estimate(values, volume, estimating, run.progress));
    run.clock.finish(voxels);
    denoised.steps.push_back({std::move(step), std::move(estimates)});
    return {};
  };
  DUBSAR_TRY(add_step(std::move(name), grid.counts));
  for (int iteration = 1; iteration <= options.iterations; ++iteration) {
    DenoiseOptions pass = options;
    pass.iterations = 1;
    if (pass.sigma <= 0.0) pass.sigma = denoised.steps.back().estimates.sigma;
    if (needs_sigma(pass.method) && pass.sigma <= 0.0) {
      log_info("denoise: the volume has no noise that could be measured, nothing to filter");
      break;
    }
    run.clock.start("denoise", "voxel");
    run.progress.begin("denoise", voxels, "voxel");
    ParallelCounts filtered(volume.dims());
    DUBSAR_TRY(denoise_in_place(volume, pass, run.progress, &filtered));
    run.clock.finish(voxels);
    DUBSAR_TRY(add_step(fmt::format("{} {}", name_in(kDenoiseMethods, pass.method), iteration), filtered.take()));
  }
  return denoised;
}

Result<Threshold> choose_threshold(std::optional<float> given, const Estimates& estimates) {
  if (given) return Threshold{*given, "given by the user", false};
  DUBSAR_ASSIGN(const double value, automatic_threshold(estimates));
  const Split& split = *taken(estimates)->split;
  const bool half_way =
      taken(estimates)->way == SplitWay::kPeaks && split.threshold == split.m_lo + 0.5 * (split.m_hi - split.m_lo);
  Threshold threshold{static_cast<float>(value), estimates.path, half_way};
  log_debug("threshold {:g}: {}", threshold.value, threshold.path);
  return threshold;
}

// All of it where there is little noise, none where there is much, in between in proportion: at the scan's resolution
// filters leave 24 to 26 dB of 17.
float sharpen_amount(double snr_db) {
  return static_cast<float>(std::clamp((snr_db - kSharpenFromDb) / (kAllFromDb - kSharpenFromDb), 0.0, 1.0));
}

float fairing_share(const EdgeSpread& blur, double snr_db) {
  const double noise = std::sqrt(2.0 * std::numbers::pi * blur.variance) * std::pow(10.0, -snr_db / 20.0);
  return static_cast<float>(std::clamp((noise - kFairFrom) / (kAllFairFrom - kFairFrom), 0.0, 1.0));
}

Result<void> extract_surface(SlabSource& source, const GridFacts& facts, const SampleOptions& options,
                             SampledSurface& sampled, StageRun run) {
  run.clock.start("extract", "voxel");
  const bool unfair = sampled.fairing > 0.0f && sampled.blur;
  run.progress.begin("extract", (unfair ? 3 : 1) * source.dims().count(), "voxel");
  const float threshold = facts.threshold.value;
  std::optional<LevelledSource> levelled;
  if (options.levels == Levels::kLocal && facts.threshold.half_way) {
    DUBSAR_ASSIGN(sampled.levels, measure_levels(source,
                                                 {threshold, static_cast<float>(facts.estimates.m_lo),
                                                  static_cast<float>(facts.estimates.m_hi), facts.constants},
                                                 run.progress));
    if (!sampled.levels->shift.empty()) {
      levelled.emplace(source, sampled.levels->shift);
      log_info("{}", describe(*sampled.levels));
    }
  }
  SlabSource& even = levelled ? static_cast<SlabSource&>(*levelled) : source;
  const ExtractOptions sampling{threshold, options.offset_bits, options.closed};
  DUBSAR_ASSIGN(sampled.samples, sample_surface(even, sampling, run.progress));
  FairSurface fair;
  std::optional<CarriedSource> carried;
  if (unfair) {
    DUBSAR_ASSIGN(fair, fair_surface(sampled.samples, sampled.blur->variance, run.progress));
    carried.emplace(even, fair.places, fair.moves, sampled.fairing);
    DUBSAR_ASSIGN(sampled.samples, sample_surface(*carried, sampling, run.progress));
  }
  SlabSource& last = carried ? static_cast<SlabSource&>(*carried) : even;
  if (const double border = share_inside_at_border(sampled.samples.signs); border > kMostBorder) {
    sampled.warning = fmt::format(
        "{:.0f} % of the border of the volume count as material: either it was cropped inside the object, or air is "
        "brighter than clay in this scan, whose grey values have to be inverted first",
        100.0 * border);
    log_warning("{}", sampled.warning);
  }
  CavityRule rule;
  if (facts.blur) rule.blur_vox = std::sqrt(facts.blur->variance);
  DUBSAR_ASSIGN(sampled.noise, fill_noise_cavities(sampled.samples, last, rule, run.progress));
  if (sampled.noise.cavities > 0)
    log_info("extract: {} cavities of {} points are noise and count as clay", sampled.noise.cavities,
             sampled.noise.points);
  run.clock.finish(source.dims().count());
  return {};
}

Result<SampledSurface> sample(GridStore& grid, const GridFacts& facts, bool denoised, const SampleOptions& options,
                              StageRun run) {
  SampledSurface sampled;
  sampled.sharpen = options.sharpen.value_or(denoised ? sharpen_amount(facts.estimates.snr_db) : 0.0f);
  const std::unique_ptr<SlabSource> sharpened = make_sharpened(grid, sampled.sharpen);
  SlabSource& source = sampled.sharpen > 0.0f ? *sharpened : static_cast<SlabSource&>(grid);
  DUBSAR_TRY(extract_surface(source, facts, options, sampled, run));
  return sampled;
}

}  // namespace dubsar
